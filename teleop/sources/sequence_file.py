"""A sequence file: keyframes in YAML to a checked performance, or every reason why not.

Two checks, both before a port opens. The file alone: shapes, times in order, nothing unknown. The file on a rig: the
axes are there, the keys lie inside the soft limits, and the planner finds a way; what it cannot plan is said at the
keyframe where it goes wrong. The rules read the plain data, so that all errors of a file come at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field

from teleop.document import Document, DocumentError, UnplayableError, Wrong, mapping, number, read_document, sequence
from teleop.motion import Action, Axis, Limits
from teleop.planner.findings import Infeasible
from teleop.planner.keyframes import Key, plan
from teleop.planner.move import Move
from teleop.section import Finite, Section
from teleop.shipped import find
from teleop.sources.times import seconds

AXES = tuple(axis.value for axis in Axis)


class Keyframe(Section):
    """What stands in the file; `at` and `hold` are times as written, the axes' positions are in their units."""

    at: Any
    hold: Any = 0
    pass_: Literal["through", "stop"] = Field("through", alias="pass")
    pan: Finite | None = None
    tilt: Finite | None = None
    roll: Finite | None = None
    focus: Finite | None = None
    stick_roll: Finite | None = None
    stick_pitch: Finite | None = None
    stick_throttle: Finite | None = None
    stick_yaw: Finite | None = None


class CueSection(Section):
    at: Any
    camera: Literal["record", "stop", "shutter"]


class SequenceSection(Section):
    title: str = ""
    fps: Annotated[float, Field(gt=0, le=1000)] | None = None
    keyframes: Annotated[list[Keyframe], Field(min_length=1)]
    cues: list[CueSection] = Field(default_factory=list)


@dataclass(frozen=True)
class Cue:
    """An action `at` so many seconds after the first keyframe's zero."""

    at: float
    action: Action


@dataclass(frozen=True)
class Performance:
    """A sequence compiled for a rig: everything that will happen, checked. `warnings` are lines for the user."""

    title: str
    move: Move
    cues: Sequence[Cue]
    warnings: Sequence[str]
    keys: Mapping[Axis, Sequence[Key]]

    @property
    def duration(self) -> float:
        """Seconds from zero to the last keyframe or cue."""
        return max([self.move.duration, *(cue.at for cue in self.cues)])


def load_performance(name: str, limits: Mapping[Axis, Limits], rig: str) -> Performance:
    """The sequence called `name`, shipped or at a path, compiled for a rig with these limits.

    Raises DocumentError with a line for everything wrong with it; UnplayableError when only the rig is in the way.
    """
    document = read_document(*find(name, "sequences", "sequence"))
    beyond_rig = list(_rig_rules(document.data, limits, rig))
    try:
        sheet = document.check(SequenceSection, [*_rules(document.data), *beyond_rig])
    except DocumentError as error:
        raise (UnplayableError(error.problems) if len(error.problems) == len(beyond_rig) else error) from None
    keys = _keys(sheet)
    try:
        move = plan(keys, {axis: limits[axis] for axis in keys})
    except Infeasible as error:
        problems = [_at_keyframe(document, finding.last, str(finding)) for finding in error.findings]
        raise UnplayableError(problems) from None
    cues = [Cue(seconds(cue.at, sheet.fps), Action(cue.camera)) for cue in sheet.cues]
    cues.sort(key=lambda cue: cue.at)
    warnings = [_at_keyframe(document, overshoot.last, str(overshoot)) for overshoot in move.overshoots]
    return Performance(sheet.title or document.name, move, cues, warnings, keys)


def _keys(sheet: SequenceSection) -> Mapping[Axis, Sequence[Key]]:
    keys: dict[Axis, list[Key]] = {}
    for index, frame in enumerate(sheet.keyframes):
        at, hold = seconds(frame.at, sheet.fps), seconds(frame.hold, sheet.fps)
        for axis in Axis:
            position = getattr(frame, axis.value)
            if position is not None:
                stop = frame.pass_ == "stop"
                keys.setdefault(axis, []).append(Key(at, position, stop, hold, f"keyframes[{index}]"))
    return {axis: keys[axis] for axis in Axis if axis in keys}


def _at_keyframe(document: Document, where: str, text: str) -> str:
    """A line for something the planner says of the keyframe that it calls `where`."""
    index = int(where.removeprefix("keyframes[").removesuffix("]"))
    line, column = document.places["keyframes", index]
    return f"{document.name}:{line}:{column}: {text}"


def _rules(data: Any) -> Iterator[Wrong]:
    """Times that are times and in order, keyframes that say something."""
    fps = number(mapping(data).get("fps"))
    before: tuple[int, float] | None = None
    free: dict[str, tuple[int, float]] = {}  # axis -> the keyframe that holds it, and until when
    for index, frame in enumerate(sequence(data, "keyframes")):
        frame = mapping(frame)
        if not any(axis in frame for axis in AXES):
            yield ("keyframes", index), f"names no axis ({', '.join(AXES[:4])})"
        at, wrong = _time(frame, "at", fps)
        hold, wrong_hold = _time(frame, "hold", fps)
        for key, text in (("at", wrong), ("hold", wrong_hold)):
            if text:
                yield ("keyframes", index, key), text
        if at is None:
            continue
        if before and at <= before[1]:
            yield ("keyframes", index, "at"), f"must be after keyframes[{before[0]}].at ({before[1]:g} s)"
        else:
            yield from _hold_rules(index, frame, at, free)
        before = (index, at)
        free.update({axis: (index, at + (hold or 0)) for axis in AXES if axis in frame})
    for index, cue in enumerate(sequence(data, "cues")):
        if wrong := _time(mapping(cue), "at", fps)[1]:
            yield ("cues", index, "at"), wrong


def _hold_rules(
    index: int, frame: Mapping[str, Any], at: float, free: Mapping[str, tuple[int, float]]
) -> Iterator[Wrong]:
    for axis, (holder, end) in free.items():
        if axis in frame and at < end:
            yield ("keyframes", index, "at"), f"must be after keyframes[{holder}] has held {axis} (until {end:g} s)"


def _time(section: Mapping[str, Any], key: str, fps: float | None) -> tuple[float | None, str]:
    """The time at a key in seconds, or what is wrong with it; a missing one is pydantic's to report."""
    if key not in section:
        return None, ""
    try:
        return seconds(section[key], fps), ""
    except ValueError as error:
        return None, str(error)


def _rig_rules(data: Any, limits: Mapping[Axis, Limits], rig: str) -> Iterator[Wrong]:
    """Every key is on an axis of the rig and inside its soft limits."""
    by_name = {axis.value: axis_limits for axis, axis_limits in limits.items()}
    for index, frame in enumerate(sequence(data, "keyframes")):
        for axis in AXES:
            position = number(mapping(frame).get(axis))
            if position is None:
                continue
            if axis not in by_name:
                yield ("keyframes", index, axis), f"cannot be: {rig} has no {axis}; it has {', '.join(by_name)}"
            elif not by_name[axis].minimum <= position <= by_name[axis].maximum:
                low, high = by_name[axis].minimum, by_name[axis].maximum
                yield ("keyframes", index, axis), f"must be within {low:g}..{high:g} ({rig}), not {position:g}"
