"""What can be said against keyframes, as values: a reader turns `first` and `last` into file:line:column.

Apart from `explain` and `remarks`, which find them, so that whoever only reports them loads no solver.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from teleop.core.axes import Axis
from teleop.core.errors import TeleopError


class PlanError(TeleopError):
    """Keys that are no plan at all."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that cannot be met.

    `limit` is "velocity", "acceleration", "jerk", "minimum" or "maximum". `factor` is how many times what the planner
    may use of it (0.95 of the axis' limit) is needed; for a soft limit it is the distance beyond in units, and there
    is no time. `seconds` is what the keys allow, `shortest` what would do, None when no time would.
    """

    axis: Axis
    first: str
    last: str
    limit: str
    factor: float
    seconds: float | None = None
    shortest: float | None = None

    def __str__(self) -> str:
        if self.seconds is None:
            return f"{self.axis}, {self.first}: {self.factor:.6g} beyond the soft limit ({self.limit})"
        remedy = "no time would do" if self.shortest is None else f"{self.shortest:.3f} s would do"
        return (
            f"{self.axis}, {self.first} to {self.last}: {self.limit} {self.factor:.2f} x its limit"
            f" in {self.seconds:.3f} s; {remedy}"
        )


@dataclass(frozen=True, slots=True)
class RampsTooLong:
    """Getting up to speed and coming to rest, both in seconds, would take longer than there is between two rests."""

    axis: Axis
    first: str
    last: str
    leave: float
    arrive: float
    seconds: float

    def __str__(self) -> str:
        return (
            f"{self.axis}, {self.first} to {self.last}: ramps of {self.leave:.3g} s and {self.arrive:.3g} s"
            f" do not fit into {self.seconds:.3f} s"
        )


@dataclass(frozen=True, slots=True)
class Unsolved:
    """The solver found no way from one rest to the next, although none of the limits forbids it."""

    axis: Axis
    first: str
    last: str

    def __str__(self) -> str:
        return f"{self.axis}, {self.first} to {self.last}: no plan was found; give it a longer ease, or more time"


class Infeasible(PlanError):  # noqa: N818  the field's word for it
    """The keys ask for more than the limits allow; `findings` holds everything that does, of all axes."""

    def __init__(self, findings: Sequence[Finding | RampsTooLong | Unsolved]) -> None:
        super().__init__("; ".join(map(str, findings)))
        self.findings = tuple(findings)


@dataclass(frozen=True, slots=True)
class Overshoot:
    """A warning: between two keys the axis has to pass them by `size` units to keep its limits."""

    axis: Axis
    first: str
    last: str
    size: float

    def __str__(self) -> str:
        return f"{self.axis}, {self.first} to {self.last}: overshoots by {self.size:.3g} to keep its limits"


@dataclass(frozen=True, slots=True)
class LongRamp:
    """A warning: at a key the limits do not allow a ramp as short as was asked for, both in seconds."""

    axis: Axis
    last: str
    asked: float
    taken: float

    def __str__(self) -> str:
        return f"{self.axis}, {self.last}: a ramp of {self.taken:.2f} s, not {self.asked:.2f} s, to keep its limits"
