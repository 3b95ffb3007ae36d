"""A sequence file: keyframes in YAML to a checked performance, or every reason why not.

Two checks, both before a port opens. The file alone: shapes, times in order, nothing unknown. The file on a rig: the
axes are there, the keys lie inside the soft limits, and the planner finds a way; what it cannot plan is said at the
keyframe where it goes wrong. The rules read the plain data, so that all errors of a file come at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from teleop.document import Document, DocumentError, UnplayableError, read_document
from teleop.motion import Action, Axis, Limits
from teleop.planner.findings import Infeasible, PlanError
from teleop.planner.keyframes import Key, plan, stretch
from teleop.planner.move import Move
from teleop.planner.repeat import Repeat, repeated
from teleop.section import PositionsSection, Section
from teleop.shipped import find
from teleop.sources.easing import ramps
from teleop.sources.sequence_rules import file_rules, rig_rules
from teleop.sources.timelapse_section import TimelapseSection
from teleop.sources.times import seconds

PREROLL = 0.5  # s at rest on the first keyframe before the start, unless the file says otherwise


class Keyframe(PositionsSection):
    """What stands in the file; `at`, `hold` and `ease` are as written, the axes' positions are in their units."""

    at: Any
    hold: Any = 0
    pass_: Literal["through", "stop"] = Field("through", alias="pass")
    ease: Any = None


class CueSection(Section):
    at: Any
    camera: Literal["record", "stop", "shutter"]


class RepeatSection(Section):
    """`times` passes; a bounce counts the way there and the way back as two."""

    times: Annotated[int, Field(ge=1, le=10_000)]
    mode: Annotated[Repeat, Field(strict=False)]


class SequenceSection(Section):
    """`tension`: 0 is smoothest, 1 closest to constant speed between keys. `fit`: what is too fast is stretched.

    `ease`: the ramps at every stop that has none of its own. `preroll`: the rest on the first keyframe before the
    start. `back_to_one`: at the end the axes go back to the first keyframe.
    """

    title: str = ""
    fps: Annotated[float, Field(gt=0, le=1000)] | None = None
    tension: Annotated[float, Field(ge=0, le=1)] = 0.0
    ease: Any = None
    fit: Literal["stretch"] | None = None
    preroll: Any = PREROLL
    back_to_one: bool = False
    repeat: RepeatSection | None = None
    timelapse: TimelapseSection | None = None
    keyframes: Annotated[list[Keyframe], Field(min_length=1)]
    cues: list[CueSection] = Field(default_factory=list)


@dataclass(frozen=True)
class Cue:
    """An action `at` so many seconds after the first keyframe's zero."""

    at: float
    action: Action


@dataclass(frozen=True)
class Performance:
    """A sequence compiled for a rig: everything that will happen, checked. `warnings` are lines for the user.

    `preroll` is how long to rest on the first keyframe before the start, in s; `back_to_one`: whether to go back to
    it after the end.
    """

    title: str
    move: Move
    cues: Sequence[Cue]
    warnings: Sequence[str]
    keys: Mapping[Axis, Sequence[Key]]
    preroll: float = PREROLL
    back_to_one: bool = False

    @property
    def duration(self) -> float:
        """Seconds from zero to the last keyframe or cue."""
        return max([self.move.duration, *(cue.at for cue in self.cues)])


def load_performance(name: str, limits: Mapping[Axis, Limits], rig: str) -> Performance:
    """The sequence called `name`, shipped or at a path, compiled for a rig with these limits.

    Raises DocumentError with a line for everything wrong with it; UnplayableError when only the rig is in the way.
    """
    document = read_document(*find(name, "sequences", "sequence"))
    beyond_rig = list(rig_rules(document.data, limits, rig))
    try:
        sheet = document.check(SequenceSection, [*file_rules(document.data), *beyond_rig])
    except DocumentError as error:
        raise (UnplayableError(error.problems) if len(error.problems) == len(beyond_rig) else error) from None
    own_limits = {axis: limits[axis] for axis in axes_of(sheet)}
    try:
        keys, move, factor = _planned(sheet, own_limits)
    except Infeasible as error:
        problems = [at_keyframe(document, finding.last, str(finding)) for finding in error.findings]
        raise UnplayableError(problems) from None
    except PlanError as error:
        raise DocumentError([document.problem(("repeat",), str(error))]) from None
    remarks = [*move.overshoots, *move.long_ramps]
    warnings = [at_keyframe(document, remark.last, str(remark)) for remark in remarks]
    if factor > 1:
        warnings.append(document.problem(("fit",), f"stretched it {factor:.3f} x, to {move.duration:.2f} s"))
    cues = [Cue(factor * seconds(cue.at, sheet.fps), Action(cue.camera)) for cue in sheet.cues]
    cues.sort(key=lambda cue: cue.at)
    title, preroll = sheet.title or Path(document.name).stem, seconds(sheet.preroll, sheet.fps)
    return Performance(title, move, cues, warnings, keys, preroll, sheet.back_to_one)


def _planned(sheet: SequenceSection, limits: Mapping[Axis, Limits]) -> tuple[Mapping[Axis, Sequence[Key]], Move, float]:
    """The keys of every pass at the times they will have, the move through them, and how far it had to be stretched."""
    keys = keys_of(sheet)
    if sheet.repeat:
        keys = repeated(keys, sheet.repeat.times, sheet.repeat.mode)
    if sheet.fit is None:
        return keys, plan(keys, limits, sheet.tension), 1.0
    move, factor = stretch(keys, limits, sheet.tension)
    return {axis: [key.later(factor) for key in of_axis] for axis, of_axis in keys.items()}, move, factor


def axes_of(sheet: SequenceSection) -> Sequence[Axis]:
    return [axis for axis in Axis if any(getattr(frame, axis.value) is not None for frame in sheet.keyframes)]


def keys_of(sheet: SequenceSection) -> Mapping[Axis, Sequence[Key]]:
    keys: dict[Axis, list[Key]] = {}
    everywhere = ramps(sheet.ease, sheet.fps)
    for index, frame in enumerate(sheet.keyframes):
        at, hold = seconds(frame.at, sheet.fps), seconds(frame.hold, sheet.fps)
        eases = ramps(frame.ease, sheet.fps, everywhere)
        for axis in Axis:
            position = getattr(frame, axis.value)
            if position is not None:
                stop = frame.pass_ == "stop"
                keys.setdefault(axis, []).append(Key(at, position, stop, hold, f"keyframes[{index}]", *eases))
    return {axis: keys[axis] for axis in axes_of(sheet)}


def at_keyframe(document: Document, where: str, text: str) -> str:
    """A line for something the planner says of the keyframe that it calls `where`."""
    index = int(where.removeprefix("keyframes[").removesuffix("]"))
    line, column = document.places["keyframes", index]
    return f"{document.name}:{line}:{column}: {text}"
