"""What can be wrong with keyframes, as values: a reader turns `first` and `last` into file:line:column.

Apart from `explain`, which finds them, so that whoever only reports them loads no solver.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from teleop.motion import Axis
from teleop.ports import TeleopError


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
        start, _, index = self.last.rpartition("[")
        last = f"[{index}" if start and self.first.startswith(f"{start}[") else self.last
        remedy = "no time would do" if self.shortest is None else f"{self.shortest:.3f} s would do"
        return (
            f"{self.axis}, {self.first}..{last}: {self.limit} {self.factor:.2f} x its limit"
            f" in {self.seconds:.3f} s; {remedy}"
        )


class Infeasible(PlanError):  # noqa: N818  the field's word for it
    """The keys ask for more than the limits allow; `findings` holds everything that does, of all axes."""

    def __init__(self, findings: Sequence[Finding]) -> None:
        super().__init__("; ".join(map(str, findings)))
        self.findings = tuple(findings)
