"""What is wrong with keyframes, as values: a caller turns `first` and `last` into file:line:column.

Their texts are made here. What finds them is in `infeasibility` and `diagnostics`, which load the solver.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from teleop.core.axes import Axis
from teleop.core.errors import TeleopError

ROOM = 1.05  # times an overshoot: what to tolerate is said with two digits
AT_LIMIT = 1.005  # a factor below this rounds to 1.00: to name the limit would explain nothing


class PlanError(TeleopError):
    """Keys that are no plan at all."""


def _amount(axis: Axis, value: float) -> str:
    """A position or a distance with its unit: `1.5 deg`, `0.02`."""
    return f"{value:.3g} {axis.unit}".rstrip()


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that the limits do not allow.

    `limit` is "velocity", "acceleration", "jerk", "minimum" or "maximum". `factor` is how many times what the planner
    may use of it (0.95 of the axis' limit) is needed; for a soft limit it is the distance beyond in units, and there
    is no time. `seconds` is what the keys allow, `shortest` the shortest time that is possible, None when it was not
    searched for; then `least` is a time that is not enough, None where only the limit is known.
    """

    axis: Axis
    first: str
    last: str
    limit: str
    factor: float
    seconds: float | None = None
    shortest: float | None = None
    least: float | None = None

    def __str__(self) -> str:
        if self.seconds is None:
            side = "below" if self.limit == "minimum" else "above"
            return f"{self.axis} is {_amount(self.axis, self.factor)} {side} its {self.limit} at {self.first}"
        way = f"from {self.first} to {self.last}"
        if self.shortest is not None:
            needs = f"{self.axis} needs {self.shortest:.3f} s {way}, not {self.seconds:.3f} s"
        elif self.least is not None:
            needs = f"{self.axis} needs more than {self.least:.3f} s {way}, not {self.seconds:.3f} s"
        else:
            needs = f"{self.axis} cannot go {way} in {self.seconds:.3f} s"
        return f"{needs}{self._excess()}; or `fit: stretch`"

    def _excess(self) -> str:
        if self.factor < AT_LIMIT:
            return ""
        times = f"{self.factor:.3g}" if self.factor < 10 else f"{self.factor:.0f}"
        return f" ({self.limit} would be {times} x its limit)"


@dataclass(frozen=True, slots=True)
class RampsTooLong:
    """Getting up to speed and coming to rest, both in seconds, would take longer than there is between two rests.

    Ramps that are shares grow with the time: `shortest` is that in which both have room, None where no time is enough.
    """

    axis: Axis
    first: str
    last: str
    leave: float
    arrive: float
    seconds: float
    shortest: float | None = None

    def __str__(self) -> str:
        both = f"{self.leave:.3g} s + {self.arrive:.3g} s"
        way = f"from {self.first} to {self.last}"
        if self.shortest is None:
            return f"{self.axis} has no time for its ramps ({both}) {way} in {self.seconds:.3f} s; use a shorter `ease`"
        needs = f"needs {self.shortest:.3f} s for its ramps ({both}) {way}, not {self.seconds:.3f} s"
        return f"{self.axis} {needs}; or a shorter `ease`"


@dataclass(frozen=True, slots=True)
class Unsolved:
    """The solver found no way from one rest to the next, although none of the limits forbids it."""

    axis: Axis
    first: str
    last: str

    def __str__(self) -> str:
        return f"{self.axis}: no plan found from {self.first} to {self.last}; use a longer `ease`, or more time"


@dataclass(frozen=True, slots=True)
class Overshooting:
    """Between two keys the axis would pass them by `size` units, more than tolerated, to keep its limits.

    Where that is known, `way` is the two keys between which more time avoids it: `seconds` it has, `shortest` it needs.
    """

    axis: Axis
    first: str
    last: str
    size: float
    way: tuple[str, str] | None = None
    seconds: float = 0.0
    shortest: float = 0.0

    def __str__(self) -> str:
        size = _amount(self.axis, self.size)
        overshoot = f"overshoot by {size} between {self.first} and {self.last}"
        more = f"`overshoot: {_rounded_up(self.size):g}`"
        if self.way is None:
            return f"{self.axis} would {overshoot}, to keep its limits; allow more time, or {more}"
        needs = f"{self.axis} needs {self.shortest:.3f} s from {self.way[0]} to {self.way[1]}, not {self.seconds:.3f} s"
        return f"{needs} (it would {overshoot}); or `fit: stretch`, or {more}"


def _rounded_up(size: float) -> float:
    """With two digits, and some room for the planner."""
    digit = 10.0 ** (math.floor(math.log10(size)) - 1)
    return math.ceil(size * ROOM / digit) * digit


class Infeasible(PlanError):  # noqa: N818  the field's word for it
    """The keys ask for more than the limits allow; `findings` holds everything that does, of all axes."""

    def __init__(self, findings: Sequence[Finding | RampsTooLong | Unsolved | Overshooting]) -> None:
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
        size = _amount(self.axis, self.size)
        return f"{self.axis} overshoots by {size} between {self.first} and {self.last}, to keep its limits"


@dataclass(frozen=True, slots=True)
class LongRamp:
    """A warning: at a key the limits do not allow a ramp as short as was asked for, both in seconds."""

    axis: Axis
    last: str
    asked: float
    taken: float

    def __str__(self) -> str:
        return f"{self.axis} needs a ramp of {self.taken:.2f} s at {self.last}, not {self.asked:.2f} s"


@dataclass(frozen=True, slots=True)
class Standstill:
    """A warning: the axis all but rests for `seconds` between two keys, although neither is a stop."""

    axis: Axis
    first: str
    last: str
    seconds: float

    def __str__(self) -> str:
        where = f"between {self.first} and {self.last}"
        return f"{self.axis} almost stops for {self.seconds:.1f} s {where}, to be fast enough beside it"
