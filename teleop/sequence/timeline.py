"""What there is to plan: keys and cues of a sequence file, and of all that it includes, on one clock.

A keyframe stands for itself, while a panorama and an included file are blocks: between their first and last key of an
axis nothing else may move that axis. An included file's first and last keys stay the stops that they are when it is
played alone, and so does the evenness of its speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

from teleop.config.documents.document import Document, Location, numbered, path_text
from teleop.config.quantities import seconds
from teleop.core.axes import Axis, Limits
from teleop.core.events import Action
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.repeat import repeated
from teleop.planner.keyframes.tension import Tension
from teleop.planner.trajectory import Move
from teleop.sequence.aim import MOST_MISSED, ON_THE_WAY, Scene, Tracked
from teleop.sequence.cues import Cue, moved_rules
from teleop.sequence.keys import Keys, KeysError, keys_of, recentered
from teleop.sequence.model import SequenceModel
from teleop.sequence.panorama import WHERE, shots
from teleop.sequence.tables.section import RUN_OUT, RUN_UP
from teleop.sequence.tables.section import WHERE as SOURCE
from teleop.sequence.tables.timed_frames import TimedFrames
from teleop.sequence.turns import long_ways, unwrapped

if TYPE_CHECKING:
    from teleop.sequence.tables.fitted_table import FittedTable

MOST_KEYS = 10_000  # of an axis, every pass of a repeat counted: the planner takes some 10 s for them


class Origin(NamedTuple):
    """Where something is written, in one of several files."""

    document: Document
    location: Location

    def line(self, text: str) -> str:
        """An error line that names this place."""
        return self.document.line(self.location, text)


class Timed(NamedTuple):
    """A cue at its time on the whole clock, in s."""

    cue: Cue
    needs_rest: bool
    place: Origin


class Aimed(NamedTuple):
    """A target that is kept in sight: where that is written; the file begins at `at` (s), `rate` times as fast."""

    tracked: Tracked
    place: Origin
    at: float = 0.0
    rate: float = 1.0

    def problem(self, move: Move, factor: float) -> str:
        """A line where the move, `factor` times longer, loses sight of the target, else ""."""
        missed, when = self.tracked.missed(move, lambda time: factor * (self.at + time / self.rate))
        if missed <= MOST_MISSED:
            return ""
        return self.place.line(
            f"{path_text(self.place.location)} misses its target by {missed:.2f} deg at {when:.2f} s:"
            " the base is too fast there; use more time"
        )


def aims_of(document: Document, model: SequenceModel) -> list[Aimed]:
    """The targets that a file keeps in sight while its base moves. Raises UnaimedError."""
    return [
        Aimed(tracked, Origin(document, ("keyframes", tracked.look.keyframe, "aim")))
        for tracked in Scene(model).tracked()
    ]


class Block(NamedTuple):
    """Keys of one axis that stand together; `name` is what errors call them."""

    keys: Sequence[Key]
    name: str
    place: Origin

    @property
    def end(self) -> float:
        return self.keys[-1].at + self.keys[-1].hold


@dataclass
class Timeline:
    """A file's keys and cues; `own` are the keys of its keyframes alone, `keys` all that are to be planned.

    `places` are the keys' by their `where`, `remarks` lines for the user.
    `frames` are those of tables, by axis.
    """

    document: Document
    model: SequenceModel
    own: Keys = field(default_factory=dict)
    keys: Keys = field(default_factory=dict)
    cues: list[Timed] = field(default_factory=list)
    places: dict[str, Origin] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    aims: list[Aimed] = field(default_factory=list)
    frames: dict[Axis, list[TimedFrames]] = field(default_factory=dict)

    @classmethod
    def of(cls, document: Document, model: SequenceModel) -> Timeline:
        """With the file's own cues and places, as yet without keys. Raises UnaimedError."""
        timeline = cls(document, model, own=keys_of(model))
        for name, count in (("keyframes", len(model.keyframes)), ("cues", len(model.cues))):
            timeline.places |= {numbered(name, index): Origin(document, (name, index)) for index in range(count)}
        for index, cue in enumerate(model.cues):
            if cue.act is not None:
                place = timeline.places[numbered("cues", index)]
                timeline.cues.append(Timed(Cue(seconds(cue.at, model.fps), cue.act), cue.needs_rest, place))
        timeline.aims = aims_of(document, model)
        followed = {numbered("keyframes", each.tracked.look.keyframe) for each in timeline.aims}
        timeline.places |= {ON_THE_WAY + key: timeline.places[key] for key in followed}
        if model.panorama:
            place = Origin(document, (WHERE,))
            for index, at in enumerate(shots(model.panorama, model.fps).shutters):
                timeline.places[numbered(WHERE, index)] = place
                timeline.cues.append(Timed(Cue(at, Action.SHUTTER), False, place))
        return timeline

    def own_blocks(self, limits: Mapping[Axis, Limits]) -> dict[Axis, list[Block]]:
        """The keyframes, each for itself, and a panorama as a whole. Adds a remark for each long way round."""
        keys = unwrapped(self.own, self.model, limits)
        self.remarks += [self.document.line(("keyframes", frame), text) for frame, text in long_ways(keys, limits)]
        blocks = {
            axis: [Block([key], key.where, self.places[key.where]) for key in of_axis] for axis, of_axis in keys.items()
        }
        if self.model.panorama:
            for axis, of_axis in shots(self.model.panorama, self.model.fps).keys.items():
                blocks.setdefault(axis, []).append(Block(of_axis, WHERE, Origin(self.document, (WHERE,))))
        return blocks

    def inserted_at(self, at: float, rate: float, name: str) -> Timeline:
        """As it is within a file that includes it as `name`, from `at` (s) on, `rate` times as fast."""
        tension = self.model.tension
        keys = {
            axis: [_inserted(key, at, rate, name, tension, key in (of_axis[0], of_axis[-1])) for key in of_axis[:-1]]
            + [_inserted(of_axis[-1], at, rate, name, None, True)]
            for axis, of_axis in self.keys.items()
        }
        cues = [timed._replace(cue=timed.cue._replace(at=at + timed.cue.at / rate)) for timed in self.cues]
        places = {f"{name}, {where}": place for where, place in self.places.items()}
        aims = [each._replace(at=at + each.at / rate, rate=each.rate * rate) for each in self.aims]
        frames = {axis: [each.moved(at, 1 / rate) for each in of_axis] for axis, of_axis in self.frames.items()}
        return replace(self, keys=keys, cues=cues, places=places, aims=aims, frames=frames)

    def add_table(self, table: FittedTable, blocks: dict[Axis, list[Block]], *, record: bool) -> None:
        """The keys of a table as blocks, its frames, and cues to `record` them."""
        place = Origin(self.document, (SOURCE,))
        lines = Document(table.table, places={(name,): (line, 1) for name, line in table.lines.items()})
        self.places |= {name: Origin(lines, (name,)) for name in table.lines} | {RUN_UP: place, RUN_OUT: place}
        self.remarks += table.remarks
        for axis, of_axis in table.keys.items():
            blocks.setdefault(axis, []).append(Block(of_axis, SOURCE, place))
            self.frames.setdefault(axis, []).append(table.frames[axis])
        if record:
            for at, action in ((0.0, Action.RECORD), (table.end, Action.STOP)):
                self.cues.append(Timed(Cue(at, action), False, place))

    def move_later(self, by: float) -> None:
        """Begin `by` s later: the run-up of a table comes before time 0 of its file."""
        self.keys = {axis: [replace(key, at=key.at + by) for key in of_axis] for axis, of_axis in self.keys.items()}
        self.cues = [timed._replace(cue=timed.cue._replace(at=timed.cue.at + by)) for timed in self.cues]
        self.aims = [each._replace(at=each.at + by) for each in self.aims]
        self.frames = {axis: [each.moved(by) for each in of_axis] for axis, of_axis in self.frames.items()}


def _inserted(key: Key, at: float, rate: float, name: str, tension: Tension | None, stop: bool) -> Key:
    later = key.later(1 / rate)
    own = key.tension if key.tension is not None else tension
    return replace(later, at=at + later.at, stop=stop or key.stop, where=f"{name}, {key.where}", tension=own)


def joined(blocks: Mapping[Axis, list[Block]]) -> tuple[Keys, list[str]]:
    """Each axis's keys in order of time, and a line for each block that needs an axis which another one has."""
    keys, problems = {}, []
    for axis in (axis for axis in Axis if axis in blocks):
        in_order = sorted(blocks[axis], key=lambda block: block.keys[0].at)
        keys[axis] = [key for block in in_order for key in block.keys]
        problems += _overlaps(axis, in_order)
    return keys, problems


def _overlaps(axis: Axis, blocks: Sequence[Block]) -> Iterator[str]:
    last = blocks[0]
    for block in blocks[1:]:
        first = block.keys[0]
        meets = abs(first.at - last.end) < SAME_TIME and first.position == last.keys[-1].position
        if first.at < last.end + SAME_TIME and not meets:
            text = f"{block.name} must begin after {last.name} ends ({axis}, {last.end:g} s)"
            yield block.place.line(
                text if block.name != last.name else f"{block.name} uses {axis} twice at the same time"
            )
        last = max(last, block, key=lambda each: each.end)


def expand(timeline: Timeline, limits: Mapping[Axis, Limits]) -> Iterator[str]:
    """Add the passes of a repeat, and the keys of recenter cues; a line for all that cannot be."""
    document, model = timeline.document, timeline.model
    times = model.repeat.times if model.repeat else 1
    for axis, of_axis in timeline.keys.items():
        if (count := (len(of_axis) - 1) * times + 1) > MOST_KEYS:
            where = ("repeat", "times") if model.repeat else ()
            yield document.problem(where, f"needs {count} keys of {axis}; the maximum is {MOST_KEYS}")
            return
    if model.repeat:
        try:
            endless = [axis for axis in timeline.keys if limits[axis].continuous]
            timeline.keys = repeated(timeline.keys, times, model.repeat.mode, endless)
        except PlanError as error:
            yield document.problem(("repeat",), str(error))
    centers = [(index, cue) for index, cue in enumerate(model.cues) if cue.recenter is not None]
    for index, cue in sorted(centers, key=lambda each: seconds(each[1].at, model.fps)):
        at, duration = seconds(cue.at, model.fps), seconds(cue.recenter, model.fps)
        try:
            timeline.keys = recentered(timeline.keys, limits, at, duration, numbered("cues", index))
        except KeysError as error:
            yield document.problem(("cues", index, "recenter"), str(error))
    for index, cue in enumerate(model.cues):
        for location, text in moved_rules(cue.model_dump(), ("cues", index), timeline.keys):
            yield document.problem(location, text)
