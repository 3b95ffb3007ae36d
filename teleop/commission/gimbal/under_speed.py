"""What a position command does while speed control is taken over: the document does not say."""

from __future__ import annotations

from teleop.commission.findings import Findings, Subject
from teleop.commission.gimbal.base import AxisStep, answered
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import FURTHEST, cruise, home, let_go, rest
from teleop.commission.gimbal.places import gone
from teleop.commission.step import Script, Wait

UNDER_SPEED = Subject("position.under_speed", "A position command under speed control")


class UnderSpeedStep(AxisStep):
    """1 degree by a position command, with speed control taken over at zero."""

    key, title = "position-under-speed", "A position command under speed control"
    subjects = (UNDER_SPEED,)

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench, index)
        self.about = (
            "Speed control is taken over with speed 0. Then a position command asks",
            f"{self.name} to go 1 deg in 0.4 s. It obeys, or it does not; then it goes back.",
        )

    def unfit(self, findings: Findings) -> str:
        bench = self.bench
        both = bench.obeys_position[self.index] and bench.speed_signs[self.index] is not None
        return super().unfit(findings) or ("" if both else f"{self.name} was not found to obey positions and speeds")

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench, index = self.bench, self.index
        bench.allow(FURTHEST)
        yield from cruise(bench, 0.0, 0.3, lambda value: bench.speed(index, value))
        before = bench.mean(0.2)
        sequence = bench.increment(index, 1.0, 0.4)
        end = bench.now + 0.45
        while bench.now < end:
            yield Wait(0.02, f"{self.name} is sent 1 deg")
        yield from rest(bench)
        moved, code = gone(before, bench.mean())[index], bench.code(sequence)
        yield from let_go(bench)
        yield from home(bench)
        obeys = abs(moved) > 0.5
        found = "is obeyed" if obeys else "is refused" if code else "is answered and ignored"
        return [UNDER_SPEED.found(found, f"{answered(code)}, moved {abs(moved):.1f} deg")]
