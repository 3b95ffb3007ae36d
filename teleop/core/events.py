"""What happens in a tick: actions for devices, and the tick as every sink sees it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from teleop.core.axes import Axis, Motion, Reading
from teleop.core.setpoints import Demand


class Action(StrEnum):
    """Something done once, by whichever sink knows how."""

    RECORD = "record"
    STOP = "stop"
    SHUTTER = "shutter"
    FOCUS = "focus"  # on the center, until END_FOCUS
    END_FOCUS = "end_focus"


class DeviceCommand(NamedTuple):
    """A command that only its device knows: `gimbal follow lock`, `focus set position=5`, `drone land`.

    `arguments` are written `field=value`. `str` is the command as `teleop send` takes it.
    """

    device: str
    name: str
    arguments: tuple[str, ...] = ()

    def __str__(self) -> str:
        return " ".join((self.device, self.name, *self.arguments))


class DialInput(NamedTuple):
    """How fast a dial is turned, -1..1, for a device that has its own use for it; 0 once when it comes to rest."""

    speed: float


class ShutterStep(StrEnum):
    """Of taking one frame of a timelapse, in this order."""

    FOCUS = "prefocus"
    PRESS = "press"
    RELEASE = "release"


class Exposure(NamedTuple):
    """A step of taking the frame with this number, counted from 0, for the sink that shoots."""

    frame: int
    step: ShutterStep


class ShutterResult(NamedTuple):
    """The camera's answer to the press for a frame: a return code, 0 for done, None without an answer."""

    frame: int
    code: int | None


class TickAt(NamedTuple):
    """Has the loop, while all rests, move its ticks so that one is at `time` (s, its clock).

    Rigs that start together thus send their first commands together.
    """

    time: float


TickEvent = Action | DeviceCommand | DialInput | Exposure  # as sinks and observers get it
SourceEvent = TickEvent | TickAt  # as sources give it


@dataclass(frozen=True, slots=True)
class Tick:
    """One turn of the control loop, as every sink and the recorder see it.

    `time` is the loop's clock in seconds, `motion` where each axis in use is commanded to be at that time, `reported`
    the last reading of each axis that has one.
    """

    time: float
    motion: Motion
    demand: Demand
    actions: Sequence[TickEvent]
    reported: Mapping[Axis, Reading]
