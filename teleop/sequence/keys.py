"""From the keyframes of a sequence file to each axis's own keys, and what cues add to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from teleop.config.documents.document import Document, numbered
from teleop.config.quantities import seconds
from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.keys import Key
from teleop.sequence.aim import ON_THE_WAY, Scene
from teleop.sequence.cues import CENTERED
from teleop.sequence.easing import ramps
from teleop.sequence.model import SequenceModel

Keys = Mapping[Axis, Sequence[Key]]


class KeysError(Exception):
    """A key that has no place; one line."""


def axes_of(model: SequenceModel) -> Sequence[Axis]:
    """The axes that some keyframe names."""
    aimed = [Axis.PAN, Axis.TILT] if any(frame.aim is not None for frame in model.keyframes) else []
    return [
        axis
        for axis in Axis
        if axis in aimed or any(getattr(frame, axis.value) is not None for frame in model.keyframes)
    ]


def keys_of(model: SequenceModel) -> Keys:
    """Each axis's keys, at the times that stand in the file. Raises UnaimedError."""
    keys: dict[Axis, list[Key]] = {axis: [] for axis in axes_of(model)}
    everywhere = ramps(model.ease, model.fps)
    for index, frame in enumerate(model.keyframes):
        at, hold = seconds(frame.at, model.fps), seconds(frame.hold, model.fps)
        eases = ramps(frame.ease, model.fps, everywhere)
        for axis, of_axis in keys.items():
            position = getattr(frame, axis.value)
            if position is not None:
                stop = frame.pass_ == "stop"
                where, overshoot = numbered("keyframes", index), model.overshoot_of(axis)
                of_axis.append(Key(at, position, stop, hold, where, *eases, overshoot=overshoot))
    for axis, of_aim in Scene(model).keys().items():
        in_order = sorted([*keys[axis], *of_aim], key=lambda key: key.at)
        if any(key.where.startswith(ON_THE_WAY) for key in of_aim):  # the geometry says how fast, and not how even
            in_order = [replace(key, tension=0.0) for key in in_order]
        keys[axis] = in_order
    return keys


def frame_of(key: Key) -> int:
    """The number (from 0) of the keyframe that a file's own key comes from."""
    return int(key.where.rpartition(" ")[2]) - 1


def line_at(document: Document, where: str, text: str) -> str:
    """A line for something the planner says of the keyframe that it calls `where`."""
    number = int(where.rpartition(" ")[2])
    return document.line(("keyframes", number - 1), text)


def recentered(keys: Keys, limits: Mapping[Axis, Limits], at: float, duration: float, where: str) -> Keys:
    """With the gimbal's axes that have keys going to 0 from `at` on, both in s; a turn that may go on for ever ends at
    the nearest whole one. Raises KeysError where one of them does not rest then, or is wanted elsewhere."""
    centered = {
        axis: _with_center(axis, keys[axis], limits[axis], at, duration, where) for axis in CENTERED if axis in keys
    }
    return {**keys, **centered}


def _with_center(
    axis: Axis, keys: Sequence[Key], limits: Limits, at: float, duration: float, where: str
) -> Sequence[Key]:
    before = [key for key in keys if key.at <= at + SAME_TIME]
    after = list(keys[len(before) :])
    last = before[-1] if before else replace(after[0], at=0.0, hold=0.0)
    rested, stops = last.at + last.hold, last.stop or last.hold > 0 or len(before) == 1 or not after
    if rested > at + SAME_TIME:
        raise KeysError(f"begins while {last.where} holds {axis} (until {rested:g} s)")
    if before and after and (not stops or at > rested + SAME_TIME) and after[0].position != last.position:
        rest = f"it rests until {rested:g} s" if stops else f"add `pass: stop` to {last.where}"
        raise KeysError(f"begins while {axis} moves to {after[0].where}; {rest}")
    if after and after[0].at <= at + duration + SAME_TIME:
        raise KeysError(f"must end before {after[0].where} ({after[0].at:g} s), where {axis} is elsewhere")
    whole = 360.0 * round(last.position / 360) if limits.continuous else 0.0
    start = replace(last, at=at, hold=0.0, stop=True, where=where)
    if before and rested >= at - SAME_TIME:
        before[-1] = replace(last, stop=True)
    else:
        before.append(start)
    return [*before, Key(at + duration, whole, True, 0.0, where, last.arrive, last.leave), *after]
