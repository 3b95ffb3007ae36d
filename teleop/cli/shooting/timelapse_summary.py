"""A timelapse in a line: how many frames, how long it takes, how long it will be shown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from teleop.config.frame_rates import shown_rate

if TYPE_CHECKING:
    from teleop.timelapse.compile import Timelapse


def summary(timelapse: Timelapse, by_hand: bool = False) -> str:
    """`720 frames, 5 s apart: 59 min 55 s of shooting, 30.00 s of clip at 24 fps`; by hand without the times."""
    slots = timelapse.slots
    apart = f"{slots.first:g} s" if not slots.change else f"{slots.first:g} to {slots.last:g} s"
    clip = (
        f", {timelapse.clip:.2f} s of clip at {shown_rate(timelapse.fps)} fps"
        if timelapse.clip and timelapse.fps
        else ""
    )
    lead = timelapse.path.lead, slots.frames - timelapse.path.lead - timelapse.moving
    still = f" ({lead[0]} still, {timelapse.moving} moving, {lead[1]} still)" if any(lead) else ""
    if by_hand:
        return f"{slots.frames} frames{still}, each shot with Enter{clip}"
    return f"{slots.frames} frames{still}, {apart} apart: {clock(slots.at(slots.frames - 1))} of shooting{clip}"


def facts(timelapse: Timelapse) -> Mapping[str, object]:
    """The same for programs; times in s."""
    slots = timelapse.slots
    return {
        "frames": slots.frames,
        "seconds": slots.at(slots.frames - 1),
        "interval": [slots.first, slots.last],
        "clip": timelapse.clip,
        "continuous": timelapse.continuous,
    }


def clock(seconds: float) -> str:
    """`2 h 3 min`, `4 min 5 s`, `4 min`, `12.5 s`."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    first, second = divmod(whole if whole < 3600 else whole // 60, 60)
    large, small = ("min", "s") if whole < 3600 else ("h", "min")
    return f"{first} {large}" + (f" {second} {small}" if second else "")
