"""A sequence file: from keyframes in YAML to a checked `CompiledSequence`, or every reason why not.

Two checks, both before a port opens. The file alone: shapes, times in order, nothing unknown. The file on a rig: the
axes are there, the keys lie inside the soft limits, and the planner finds a way; what it cannot plan is an error at the
keyframe where it goes wrong. The rules read the plain data, so that all errors of a file come at once.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from teleop.config.documents.document import ENTRIES, Document, DocumentError, UnplayableError, path_text
from teleop.config.quantities import seconds
from teleop.config.resources import find
from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.planner import Key, plan, stretch
from teleop.planner.keyframes.rests import AT_REST, Rest, rests
from teleop.planner.trajectory import Move
from teleop.sequence.aim import ON_THE_WAY
from teleop.sequence.cues import Cue, Wait
from teleop.sequence.keys import Keys
from teleop.sequence.model import PREROLL, SequenceModel
from teleop.sequence.reader import SequenceReader
from teleop.sequence.refusal import Found, refusal
from teleop.sequence.tables.section import WHERE
from teleop.sequence.tables.timed_frames import TimedFrames
from teleop.sequence.timeline import Origin, Timed


@dataclass(frozen=True)
class CompiledSequence:
    """A sequence compiled for a rig: everything that will happen, checked. `warnings` are lines for the user.

    `preroll` is how long to rest on the first keyframe before the start, in s; `back_to_one`: whether to go back to
    it after the end. `fps` is what the file counts frames by, if it does. `frames` are those of tables.
    `fov` is the field of view of a panorama, across and up, in deg.
    """

    title: str
    move: Move
    cues: Sequence[Cue]
    warnings: Sequence[str]
    keys: Mapping[Axis, Sequence[Key]]
    preroll: float = PREROLL
    back_to_one: bool = False
    fps: float | None = None
    frames: Mapping[Axis, Sequence[TimedFrames]] = field(default_factory=dict)
    fov: tuple[float, float] | None = None

    @property
    def key_times(self) -> Sequence[float]:
        """When each key of the file begins (s), key 1 first; where it has none of its own, the times of all keys."""
        keys = [key for of_axis in self.keys.values() for key in of_axis]
        own: dict[int, float] = {}
        for key in keys:
            kind, _, number = key.where.partition(" ")
            if kind == ENTRIES["keyframes"]:
                own[int(number)] = min(key.at, own.get(int(number), math.inf))
        return [own[number] for number in sorted(own)] or sorted({key.at for key in keys})

    @property
    def duration(self) -> float:
        """Seconds from zero to the last keyframe or cue."""
        return max([self.move.duration, *(cue.at for cue in self.cues)])


def load_sequence(
    name: str, limits: Mapping[Axis, Limits], rig: str, devices: Collection[str] | None = None
) -> CompiledSequence:
    """The sequence called `name`, shipped or at a path, compiled for a rig with these limits.

    `devices` are the kinds of device that the rig has, None where that is not known. Raises DocumentError with a line
    for everything wrong with it; UnplayableError when only the rig is in the way.
    """
    reader = SequenceReader(limits, rig, devices)
    timeline = reader.read(*find(name, "sequences", "sequence"))
    if timeline is None:
        kind = UnplayableError if len(reader.problems) + reader.more == reader.beyond_rig else DocumentError
        raise kind(reader.problems, reader.more)
    model, document = timeline.model, timeline.document
    if model.timelapse is not None:
        raise DocumentError([document.problem(("timelapse",), "has keyframes in frames: it is shot, not played")])
    try:
        keys, move, factor = _planned(timeline.keys, model, {axis: limits[axis] for axis in timeline.keys})
    except Infeasible as error:
        raise refusal(error, timeline.places, _text) from None
    cues = [timed._replace(cue=timed.cue._replace(at=factor * timed.cue.at)) for timed in timeline.cues]
    if problems := [text for aimed in timeline.aims if (text := aimed.problem(move, factor))]:
        raise UnplayableError(problems)
    if problems := list(_restless(cues, move)):
        raise DocumentError(problems)
    frames = {axis: [each.moved(0, factor) for each in of_axis] for axis, of_axis in timeline.frames.items()}
    if problems := list(_off(frames, move, document)):
        raise UnplayableError(problems)
    remarks = [each for each in move.remarks if not _is_of_table(timeline.places[each.last])]
    warnings = [*timeline.remarks, *(timeline.places[remark.last].line(str(remark)) for remark in remarks)]
    if factor > 1:
        warnings.append(document.problem(("fit",), f"stretched it {factor:.3f} x, to {move.duration:.2f} s"))
        if sticks := [axis for axis in move.tracks if axis.is_stick]:
            warnings.append(document.problem(("fit",), f"does so to {', '.join(sticks)} too: the drone flies further"))
    title, preroll = model.called(document.name), seconds(model.preroll, model.fps)
    fov = (model.panorama.fov[0], model.panorama.fov[1]) if model.panorama else None
    done = [timed.cue for timed in cues]
    return CompiledSequence(title, move, done, warnings, keys, preroll, model.back_to_one, model.fps, frames, fov)


def _off(frames: Mapping[Axis, Sequence[TimedFrames]], move: Move, document: Document) -> Iterator[str]:
    """A line for each table that the planned move does not follow within its tolerance."""
    for axis, of_axis in frames.items():
        for each in of_axis:
            worst = each.deviation(move.tracks[axis])
            if worst.size > each.tolerance:
                amount = f"{worst.size:.3g} {axis.unit}".rstrip()
                text = f": {axis} is {amount} off at frame {worst.frame} of {each.table}, and may be {each.tolerance:g}"
                yield document.problem((WHERE,), f"{text}; use a higher tolerance, or a lower fps")


def _is_of_table(place: Origin) -> bool:
    """Whether a key is made of a table: that it is near enough to the frames is checked by `_off`."""
    return place.location[:1] == (WHERE,) or str(place.location[:1][0]).startswith("frame ")


def _text(found: Found) -> str:
    """What is wrong; the keys of one aim stand in no file, and are one."""
    if ON_THE_WAY in found.first or ON_THE_WAY in found.last:
        return f"{found.axis} cannot keep the target in sight: the base is too fast there; use more time"
    return str(found)


def _planned(keys: Keys, model: SequenceModel, limits: Mapping[Axis, Limits]) -> tuple[Keys, Move, float]:
    """The keys at the times they will have, the move through them, and how far it had to be stretched."""
    if model.fit is None:
        return keys, plan(keys, limits, model.tension), 1.0
    move, factor = stretch(keys, limits, model.tension)
    return {axis: [key.later(factor) for key in of_axis] for axis, of_axis in keys.items()}, move, factor


def _restless(cues: Sequence[Timed], move: Move) -> Iterator[str]:
    """A line for each cue that needs rest and has none, with what would be right."""
    places = rests(move)
    for (at, action), needs_rest, place in cues:
        held = [axis for axis, state in move.at(at).items() if axis.is_stick and abs(state.position) > AT_REST]
        if needs_rest and not any(rest.start - SAME_TIME <= at <= rest.end + SAME_TIME for rest in places):
            yield place.line(f"{path_text(place.location)} {_where_it_may_be(move, places, at)}")
        elif isinstance(action, Wait) and held:
            text = f"holds {' and '.join(held)} deflected, so the drone keeps flying: bring it to 0 before"
            yield place.line(f"{path_text(place.location)} {text}")


def _where_it_may_be(move: Move, places: Sequence[Rest], at: float) -> str:
    """Why a cue may not be `at` its time (s), and the nearest rests before and after it."""
    moving = [axis for axis, state in move.at(at).items() if abs(state.velocity) > AT_REST] or list(move.tracks)
    before = max((rest.end for rest in places if rest.end < at), default=None)
    after = min((rest.start for rest in places if rest.start > at), default=None)
    times = " or ".join(f"{time:g} s" for time in (before, after) if time is not None)
    what = f"{' and '.join(moving)} move{'' if len(moving) > 1 else 's'}"
    return f"is at {at:g} s, while {what}; put it at {times}, or add a key with `pass: stop` at {at:g} s"
