"""A go-motion as DFMoco asks for it (`bf`): a frame's exposure, and each motor's places of three frames."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from teleop.core.axes import Axis, Limits
from teleop.exchange.dfmoco.motors import Motor
from teleop.planner.go_motion import ExposureRuns

LONGEST = 3_600_000  # ms
FULL_BLUR = 1000
Places = tuple[float, float, float]


@dataclass(frozen=True)
class Exposure:
    """`seconds` of exposure, `blur` 0 .. 1, and the places p0, p1, p2 of each axis, in units."""

    seconds: float
    blur: float
    places: Mapping[Axis, Places]

    def why_not(self, limits: Mapping[Axis, Limits]) -> str:
        """Why the rig cannot, "" if it can."""
        for axis in self.places:
            if axis not in limits:
                return f"go-motion: the rig has no {axis}"
            if over := self._run(axis, limits[axis]).over():
                return f"go-motion: {axis} would exceed its {over} limit"
        return ""

    def starts(self, limits: Mapping[Axis, Limits]) -> dict[Axis, float]:
        """Where the run of each axis begins, in units."""
        return {axis: float(self._run(axis, limits[axis]).starts[0]) for axis in self.places}

    def command(self) -> dict[str, Any]:
        """That of the door."""
        before, axes, after = ({axis.value: of[i] for axis, of in self.places.items()} for i in range(3))
        return {
            "do": "go_motion",
            "axes": axes,
            "before": before,
            "after": after,
            "exposure": self.seconds,
            "blur": self.blur,
        }

    def _run(self, axis: Axis, limits: Limits) -> ExposureRuns:
        return ExposureRuns.once(*self.places[axis], self.blur, self.seconds, limits)


def exposure_of(numbers: Sequence[int], motors: Sequence[Motor]) -> Exposure | None:
    """That of the numbers of a `bf`: ms, blur in 1/1000, then each motor with its p0, p1, p2; None for what is none."""
    milliseconds, blur, *rest = numbers
    if not (0 < milliseconds <= LONGEST and 0 <= blur <= FULL_BLUR):
        return None
    places: dict[Axis, Places] = {}
    for i in range(0, len(rest), 4):
        number, *steps = rest[i : i + 4]
        if not 1 <= number <= len(motors):
            return None
        motor = motors[number - 1]
        before, place, after = (motor.target(each) for each in steps)
        places[motor.axis] = before, place, after
    return Exposure(milliseconds / 1000, blur / FULL_BLUR, places)
