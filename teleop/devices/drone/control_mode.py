"""What the two ways to hold a drone have in common: the virtual RC (`virtual_rc`), and movement commands (`movement`).

A control mode decides what is sent, not when. Both take the same four sticks, -1..1, with the same sense: roll right,
pitch forward, throttle up, yaw right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from enum import IntEnum
from typing import Protocol

from teleop.core.axes import Axis
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.enums import ArmOrder, FlightStatus

Deflections = Mapping[Axis, float]
STANDBY_WITHIN = 0.2  # s: an older word of standing on the ground is none to touch the motors by
ARMING: Mapping[str, ArmOrder] = {"arm": ArmOrder.ARM, "disarm": ArmOrder.DISARM}


class ControlMode(Protocol):
    """One way to hold a drone; `what` is what is taken, `period` is s between two frames."""

    what: str
    period: float
    notify: Callable[[str], object]
    alone: str  # what becomes of the drone when nothing more reaches it
    gap: float  # s between two takings, at least
    taken: float  # s: when an earlier run took it last, -inf if none is known to have
    repeats: bool  # whether giving back is sent again until it is confirmed

    @property
    def patience(self) -> float:
        """How long the drone may take to confirm that it is taken (s)."""
        ...

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:
        """Why the drone cannot be held so now."""
        ...

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]: ...

    def take(self, seen: Telemetry, now: float) -> None: ...

    def watch(self, seen: Telemetry, now: float) -> None:
        """Look at what the drone does by itself, held or not."""
        ...

    def drive(self, sticks: Deflections, seen: Telemetry, now: float) -> None:
        """Send the sticks as they are."""
        ...

    def neutral(self, seen: Telemetry, now: float) -> None:
        """Send what leaves the drone where it is."""
        ...

    def withdraw(self) -> None:
        """Send nothing again that the drone has not acknowledged: its sender is leaving, or gone."""
        ...

    def give_back(self, now: float) -> None: ...

    def give_back_again(self, now: float) -> None:
        """It is not confirmed yet: send it again, at its own pace, where that is of use."""
        ...

    def contradicted(self, seen: Telemetry, now: float) -> bool:
        """Whether the drone says that it is held, though it was given back, and giving back again is of use."""
        ...

    def held(self, seen: Telemetry, now: float) -> bool | None:
        """Whether the drone says that it is held so, None where it says nothing."""
        ...

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        """Carry out an operator's command; what to tell the operator of it. Raises KeyError for an unknown one."""
        ...


def not_in_standby(seen: Telemetry, now: float) -> str:
    """Why motors must not be started or stopped now, "" when they may: the drone has to report standby, now."""
    status = seen.get("status", now, STANDBY_WITHIN)
    if status == FlightStatus.STANDBY:
        return ""
    return "the drone does not report its flight status" if status is None else f"the drone reports {word_of(status)}"


def word_of(value: object) -> str:
    """A number that the drone sent, by its word where it has one."""
    return value.name.lower().replace("_", " ") if isinstance(value, IntEnum) else f"{value}"


def attitude(quaternion: object) -> tuple[float, float, float]:
    """Roll, pitch and yaw in deg, from the ground frame (north, east, down) to the body's."""
    w, x, y, z = (getattr(quaternion, name) for name in ("q0", "q1", "q2", "q3"))
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return math.degrees(roll), math.degrees(pitch), math.degrees(yaw)
