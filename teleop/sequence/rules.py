"""What must hold between the values of a sequence file: rules over its plain data, so that all errors come at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

from teleop.config.documents.document import Location, Wrong, mapping, number, numbered, sequence
from teleop.config.documents.messages import ALIASES, missing_space
from teleop.config.quantities import frame_rate, frames, percentage, seconds
from teleop.core.axes import STICKS, Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.sequence.aim_section import aim_rules
from teleop.sequence.cues import cue_rules
from teleop.sequence.easing import ease_rules
from teleop.sequence.panorama import panorama_limits, panorama_rules
from teleop.sequence.smoothness import smoothness_rules
from teleop.sequence.tables.section import source_limits, source_rules
from teleop.sequence.timelapse_section import is_timelapse, timelapse_rules

AXES = tuple(axis.value for axis in Axis)


class _Held(NamedTuple):
    """Which keyframe (from 0) has an axis, until when, and where."""

    holder: int
    until: float
    position: Any


When = Callable[[Any], float]  # a time as written -> seconds, or output frames
SLOWEST, FASTEST = 0.01, 10.0  # of an included move
DEVICES = {"camera": "camera", "follow": "gimbal", "send": "gimbal"}  # what performs a cue


def file_rules(data: Any) -> Iterator[Wrong]:
    """Times that are times and in order, keyframes that say something."""
    fps = frame_rate(mapping(data).get("fps"))
    when = frames if is_timelapse(data) else partial(seconds, fps=fps)
    yield from _keyframe_rules(data, when)
    yield from _stick_rules(data)
    yield from aim_rules(data)
    yield from smoothness_rules(data)
    if isinstance(data, dict) and not data.keys() & {"keyframes", "include", "panorama", "source"}:
        yield ("keyframes",), "is missing"
    if is_timelapse(data):
        yield from ease_rules(data, 1.0)  # a ramp of 24f takes 24 frames
        yield from timelapse_rules(data)
        return
    yield from ease_rules(data, fps)
    if wrong := _time(mapping(data), "preroll", when)[1]:
        yield ("preroll",), wrong
    yield from panorama_rules(data, fps)
    yield from source_rules(data, fps)
    for index, cue in enumerate(sequence(data, "cues")):
        yield from cue_rules(cue, ("cues", index))
        if wrong := _time(mapping(cue), "at", when)[1]:
            yield ("cues", index, "at"), wrong
        if mapping(cue).get("recenter") is not None and (wrong := _time(mapping(cue), "recenter", when)[1]):
            yield ("cues", index, "recenter"), wrong
    for index, entry in enumerate(sequence(data, "include")):
        yield from _include_rules(mapping(entry), ("include", index), when)


def _keyframe_rules(data: Any, when: When) -> Iterator[Wrong]:
    before: tuple[int, float] | None = None
    free: dict[str, _Held] = {}
    for index, frame in enumerate(sequence(data, "keyframes")):
        if missing_space(frame):
            continue
        frame = mapping(frame)
        if all(frame.get(key) is None for key in (*AXES, "aim", "base")) and not any(
            ALIASES.get(key) in AXES for key in frame
        ):
            yield ("keyframes", index), f"has no axis ({', '.join(AXES[:4])})"
        at, wrong = _time(frame, "at", when)
        hold, wrong_hold = _time(frame, "hold", when)
        for key, text in (("at", wrong), ("hold", wrong_hold)):
            if text:
                yield ("keyframes", index, key), text
        if at is None:
            continue
        if before and at < before[1] + SAME_TIME:
            yield (
                ("keyframes", index, "at"),
                f"must be after {numbered('keyframes', before[0])} ({_time_text(before[1], when)})",
            )
        else:
            yield from _hold_rules(index, frame, at, free, when)
        before = (index, at)
        free.update({axis: _Held(index, at + (hold or 0), frame.get(axis)) for axis in _named(frame)})


def _named(frame: Mapping[str, Any]) -> list[str]:
    """What a keyframe says something of: axes, and the base."""
    aimed = ("pan", "tilt") if frame.get("aim") is not None else ()
    return [axis for axis in (*AXES, "base") if axis in aimed or frame.get(axis) is not None]


def _include_rules(entry: Mapping[str, Any], here: Location, when: When) -> Iterator[Wrong]:
    if wrong := _time(entry, "at", when)[1]:
        yield (*here, "at"), wrong
    try:
        if "speed" in entry and not SLOWEST <= percentage(entry["speed"]) <= FASTEST:
            yield (*here, "speed"), f"must be {SLOWEST:.0%} to {FASTEST:.0%}"
    except ValueError as error:
        yield (*here, "speed"), str(error)


def _stick_rules(data: Any) -> Iterator[Wrong]:
    """A drone is left with its sticks in the middle, and taken over so."""
    for stick in STICKS:
        named = [
            (index, number(mapping(frame)[stick]))
            for index, frame in enumerate(sequence(data, "keyframes"))
            if mapping(frame).get(stick) is not None
        ]
        for which, (index, position) in (("first", named[0]), ("last", named[-1])) if named else ():
            if position:
                yield ("keyframes", index, stick), f"must be 0 in its {which} key, where the drone is to hover"


def _hold_rules(
    index: int, frame: Mapping[str, Any], at: float, free: Mapping[str, _Held], when: When
) -> Iterator[Wrong]:
    """A key may begin where a hold ends only if it is at the same position."""
    for axis, (holder, end, position) in free.items():
        first = end - SAME_TIME if frame.get(axis) == position else end + SAME_TIME
        if axis in _named(frame) and at < first:
            yield (
                ("keyframes", index, "at"),
                f"must be after {numbered('keyframes', holder)} has held {axis} (until {_time_text(end, when)})",
            )


def _time_text(time: float, when: When) -> str:
    return f"frame {time:g}" if when is frames else f"{time:g} s"


def _time(section: Mapping[str, Any], key: str, when: When) -> tuple[float | None, str]:
    """The time at a key in seconds or frames, or what is wrong with it; a missing one is pydantic's to report."""
    if key not in section:
        return None, ""
    try:
        return when(section[key]), ""
    except ValueError as error:
        return None, str(error)


def rig_rules(
    data: Any, limits: Mapping[Axis, Limits], rig: str, devices: Collection[str] | None = None
) -> Iterator[Wrong]:
    """Every key is on an axis of the rig and inside its soft limits, and for every cue there is a device."""
    for index, cue in enumerate(sequence(data, "cues")):
        for kind, device in DEVICES.items():
            if devices is not None and kind in mapping(cue) and device not in devices:
                yield ("cues", index, kind), f": {rig} has no {device}; its sinks are {', '.join(devices)}"
    by_name = {axis.value: axis_limits for axis, axis_limits in limits.items()}
    yield from panorama_limits(data, by_name, rig)
    yield from source_limits(data, by_name, rig)
    if devices is not None and "camera" not in devices and mapping(data, "panorama"):
        yield ("panorama",), f": {rig} has no camera; its sinks are {', '.join(devices)}"
    for index, frame in enumerate(sequence(data, "keyframes")):
        named = [axis for axis in AXES if mapping(frame).get(axis) is not None and axis in by_name]
        if mapping(frame).get("through") == "shortest" and named and not any(by_name[a].continuous for a in named):
            yield (
                ("keyframes", index, "through"),
                f": on {rig} {' and '.join(named)} cannot turn round: it has a min",
            )
        for axis in AXES:
            position = number(mapping(frame).get(axis))
            if axis in ("pan", "tilt") and axis not in by_name and mapping(frame).get("aim") is not None:
                yield ("keyframes", index, "aim"), f": {rig} has no {axis}; it has {', '.join(by_name)}"
            if position is None or not math.isfinite(position):
                continue
            if axis not in by_name:
                yield ("keyframes", index, axis), f": {rig} has no {axis}; it has {', '.join(by_name)}"
            elif not by_name[axis].minimum <= position <= by_name[axis].maximum:
                low, high = by_name[axis].minimum, by_name[axis].maximum
                yield ("keyframes", index, axis), f"must be within {low:g}..{high:g} ({rig}), not {position:g}"
