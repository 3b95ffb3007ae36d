"""A sequence file: keyframes in YAML to a checked performance, or every reason why not.

Two checks, both before a port opens. The file alone: shapes, times in order, nothing unknown. The file on a rig: the
axes are there, the keys lie inside the soft limits, and the planner finds a way; what it cannot plan is said at the
keyframe where it goes wrong. The rules read the plain data, so that all errors of a file come at once.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from teleop.document import Document, DocumentError, UnplayableError, read_document
from teleop.motion import Axis, Limits
from teleop.planner.findings import Infeasible, PlanError
from teleop.planner.keyframes import Key, plan, stretch
from teleop.planner.move import Move
from teleop.planner.repeat import repeated
from teleop.planner.rests import SAME, Rest, rests
from teleop.shipped import find
from teleop.sources.cues import Cue
from teleop.sources.sequence_keys import KeysError, axes_of, keys_of, recentred
from teleop.sources.sequence_rules import STICKS, file_rules, rig_rules
from teleop.sources.sequence_section import PREROLL, SequenceSection
from teleop.sources.times import seconds


@dataclass(frozen=True)
class Performance:
    """A sequence compiled for a rig: everything that will happen, checked. `warnings` are lines for the user.

    `preroll` is how long to rest on the first keyframe before the start, in s; `back_to_one`: whether to go back to
    it after the end. `fps` is what the file counts frames by, if it does.
    """

    title: str
    move: Move
    cues: Sequence[Cue]
    warnings: Sequence[str]
    keys: Mapping[Axis, Sequence[Key]]
    preroll: float = PREROLL
    back_to_one: bool = False
    fps: float | None = None

    @property
    def duration(self) -> float:
        """Seconds from zero to the last keyframe or cue."""
        return max([self.move.duration, *(cue.at for cue in self.cues)])


def load_performance(
    name: str, limits: Mapping[Axis, Limits], rig: str, devices: Collection[str] | None = None
) -> Performance:
    """The sequence called `name`, shipped or at a path, compiled for a rig with these limits.

    `devices` are the kinds of device that the rig has, None where that is not known. Raises DocumentError with a line
    for everything wrong with it; UnplayableError when only the rig is in the way.
    """
    document = read_document(*find(name, "sequences", "sequence"))
    beyond_rig = list(rig_rules(document.data, limits, rig, devices))
    try:
        sheet = document.check(SequenceSection, [*file_rules(document.data), *beyond_rig])
    except DocumentError as error:
        raise (UnplayableError(error.problems) if len(error.problems) == len(beyond_rig) else error) from None
    own_limits = {axis: limits[axis] for axis in axes_of(sheet)}
    keys = _keys(document, sheet, own_limits)
    try:
        keys, move, factor = _planned(keys, sheet, own_limits)
    except Infeasible as error:
        problems = [at_keyframe(document, finding.last, str(finding)) for finding in error.findings]
        raise UnplayableError(problems) from None
    cues = _cues(sheet, factor)
    problems = [document.problem(("cues", index), text) for index, text in _restless(sheet, move, factor)]
    if problems:
        raise DocumentError(problems)
    remarks = [*move.overshoots, *move.long_ramps]
    warnings = [at_keyframe(document, remark.last, str(remark)) for remark in remarks]
    if factor > 1:
        warnings.append(document.problem(("fit",), f"stretched it {factor:.3f} x, to {move.duration:.2f} s"))
        if sticks := [axis for axis in move.tracks if axis in STICKS]:
            warnings.append(document.problem(("fit",), f"does so to {', '.join(sticks)} too: the drone flies further"))
    title, preroll = sheet.title or Path(document.name).stem, seconds(sheet.preroll, sheet.fps)
    return Performance(title, move, cues, warnings, keys, preroll, sheet.back_to_one, sheet.fps)


def _keys(document: Document, sheet: SequenceSection, limits: Mapping[Axis, Limits]) -> Mapping[Axis, Sequence[Key]]:
    """The keys of every pass, and those that recentre cues add. Raises DocumentError."""
    keys, problems = keys_of(sheet), []
    if sheet.repeat:
        try:
            keys = repeated(keys, sheet.repeat.times, sheet.repeat.mode)
        except PlanError as error:
            raise DocumentError([document.problem(("repeat",), str(error))]) from None
    centres = [(index, cue) for index, cue in enumerate(sheet.cues) if cue.recenter is not None]
    for index, cue in sorted(centres, key=lambda each: seconds(each[1].at, sheet.fps)):
        at, duration = seconds(cue.at, sheet.fps), seconds(cue.recenter, sheet.fps)
        try:
            keys = recentred(keys, limits, at, duration, f"cues[{index}]")
        except KeysError as error:
            problems.append(document.problem(("cues", index, "recenter"), str(error)))
    if problems:
        raise DocumentError(problems)
    return keys


def _planned(
    keys: Mapping[Axis, Sequence[Key]], sheet: SequenceSection, limits: Mapping[Axis, Limits]
) -> tuple[Mapping[Axis, Sequence[Key]], Move, float]:
    """The keys at the times they will have, the move through them, and how far it had to be stretched."""
    if sheet.fit is None:
        return keys, plan(keys, limits, sheet.tension), 1.0
    move, factor = stretch(keys, limits, sheet.tension)
    return {axis: [key.later(factor) for key in of_axis] for axis, of_axis in keys.items()}, move, factor


def _cues(sheet: SequenceSection, factor: float) -> list[Cue]:
    """What is done beside the motion, in order of time; at one time, in the file's order."""
    cues = [Cue(factor * seconds(cue.at, sheet.fps), cue.act) for cue in sheet.cues if cue.act is not None]
    return sorted(cues, key=lambda cue: cue.at)


def _restless(sheet: SequenceSection, move: Move, factor: float) -> Iterator[tuple[int, str]]:
    """Cues that need rest and have none, each with what would be right."""
    places = rests(move)
    for index, cue in enumerate(sheet.cues):
        at = factor * seconds(cue.at, sheet.fps)
        if cue.needs_rest and not any(rest.start - SAME <= at <= rest.end + SAME for rest in places):
            yield index, _elsewhere(move, places, at)


def _elsewhere(move: Move, places: Sequence[Rest], at: float) -> str:
    """Why a cue may not be there, and where the nearest place is."""
    moving = [axis for axis, state in move.at(at).items() if abs(state.velocity) > SAME] or list(move.tracks)
    nearest = min(places, key=lambda rest: max(rest.start - at, at - rest.end))
    where = nearest.start if nearest.start > at else nearest.end
    what = f"{' and '.join(moving)} move{'' if len(moving) > 1 else 's'}"
    return f"is at {at:g} s, where {what}; all rest at {where:g} s, and would here with pass: stop in a key of each"


def at_keyframe(document: Document, where: str, text: str) -> str:
    """A line for something the planner says of the keyframe, or the cue, that it calls `where`."""
    section, index = re.fullmatch(r"(\w+)\[(\d+)\]", where).groups()  # type: ignore[union-attr] - our own words
    line, column = document.places[section, int(index)]
    return f"{document.name}:{line}:{column}: {text}"
