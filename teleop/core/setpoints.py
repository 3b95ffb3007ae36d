"""What a source asks of an axis: one setpoint per axis and tick."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from teleop.core.axes import Axis


class VelocityTarget(NamedTuple):
    """Move at this velocity (unit/s) until the next setpoint, as a stick asks.

    `acceleration` and `jerk` are an operator's gentler limits; None is the axis's own. They never exceed the axis's.
    """

    velocity: float
    acceleration: float | None = None
    jerk: float | None = None


class PositionTarget(NamedTuple):
    """Be at rest at `position`, `arrive` seconds from now or, when None, as soon as the limits allow.

    `velocity` (unit/s) is the most that an axis on its own, without an `arrive`, may go; None is the axis's own.
    """

    position: float
    arrive: float | None = None
    velocity: float | None = None


class StateTarget(NamedTuple):
    """Be in this state at the next tick, as a compiled move asks."""

    position: float
    velocity: float
    acceleration: float


class Stop(NamedTuple):
    """Come to rest as fast as the axis's own limits allow, and stay; a stick, in its center."""


Setpoint = VelocityTarget | PositionTarget | StateTarget | Stop
Demand = Mapping[Axis, Setpoint]  # an axis that is absent: no opinion
