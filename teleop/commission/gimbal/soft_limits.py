"""Soft limits, taught by driving an axis to each end with the keys."""

from __future__ import annotations

import math

from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.gimbal.base import AxisStep
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import home, let_go, rest, wait
from teleop.commission.gimbal.stop import can_move, move
from teleop.commission.page import DOWN, GO, LEFT, RIGHT, UP
from teleop.commission.step import Question, Script
from teleop.config.wiring import half_turn

SPEED = 10.0  # deg/s, once the operator has agreed to it
STEPS = {RIGHT: 2.0, UP: 2.0, LEFT: -2.0, DOWN: -2.0, "L": 10.0, "K": 10.0, "H": -10.0, "J": -10.0}
"""What each key drives, in deg."""
KEYS = {
    "pan": {LEFT: "left", RIGHT: "right", "H": "left by 10", "L": "right by 10"},
    "tilt": {DOWN: "down", UP: "up", "J": "down by 10", "K": "up by 10"},
    "roll": {LEFT: "counterclockwise", RIGHT: "clockwise", "H": "by -10", "L": "by 10"},
}
ENDS = {"pan": ("left", "right"), "tilt": ("lower", "upper"), "roll": ("counterclockwise", "clockwise")}
BLOCKED = 0.5  # share of a step that an axis at its stop does not go
MARGIN = 1.0  # deg from a mechanical stop


class SoftLimitsStep(AxisStep):
    """Each end of an axis, where the operator drives it."""

    consent = f"It goes as far as you drive it, at up to {SPEED:g} deg/s."

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench, index)
        self.key, self.title = f"soft-limits-{self.name}", f"Soft limits: {self.name}"
        coarse = " and ".join(key for key in KEYS[self.name] if len(key) == 1)
        self.about = (
            f"Drive {self.name} to its {ENDS[self.name][0]} end, as far as the shot and the cables allow:",
            f"the arrow keys go 2 deg, {coarse} 10 deg. Enter marks it.",
            "Then the other end. It goes back to where it began.",
        )
        name = self.name
        self.low = Subject(f"soft.min.{name}", f"Lower soft limit of {name}", None, "deg")
        self.high = Subject(f"soft.max.{name}", f"Upper soft limit of {name}", None, "deg")
        self.beyond = Subject(f"soft.beyond.{name}", f"A target of {name} beyond its stop", None)
        self.subjects = (self.low, self.high, self.beyond)
        self._beyond: Fact | None = None

    def unfit(self, findings: Findings) -> str:
        if why := super().unfit(findings):
            return why
        if findings.value(f"sign.report.{self.name}") is None:
            return f"which way {self.name} counts was not found"
        return "" if can_move(self.bench, self.index) else f"nothing was found that moves {self.name}"

    def script(self, findings: Findings) -> Script:
        bench = self.bench
        sign = int(findings.value(f"sign.report.{self.name}") or 1)
        mount = findings.value("recenter.yaw") if self.index == 0 else None
        middle = mount if isinstance(mount, int | float) and abs(mount) > 3 else 0.0
        self._beyond = None
        ends = []
        for end in ENDS[self.name]:
            place = yield from self._driven(end, sign)
            ends.append(round(sign * half_turn(place - middle), 1))
        low, high = sorted(ends)
        bench.back_speed, before = SPEED, bench.back_speed
        try:
            yield from home(bench)
        finally:
            bench.back_speed = before
        if high - low < 1.0:
            how = "both ends were marked at the same place"
            return [self.low.not_seen(how), self.high.not_seen(how), self.beyond.not_seen(how)]
        how = "the operator drove it there"
        beyond = self._beyond or self.beyond.not_seen("it was not driven to a stop")
        return [self.low.found(low, how), self.high.found(high, how), beyond]

    def _driven(self, end: str, sign: int):
        """Where the operator marks an end."""
        bench, index, choices = self.bench, self.index, {**KEYS[self.name], GO: "marks it"}
        at_stop = 0.0
        while True:
            here = bench.mean(0.1)[index]
            text = f"Drive {self.name} to its {end} end. It is at {sign * here:+.1f} deg."
            key = yield Question(text, choices, seconds=0.2)
            if key == GO:
                yield from rest(bench, 0.2)
                return bench.mean()[index] - at_stop
            if step := STEPS.get(key, 0.0):
                way = yield from self._by(sign * step)
                blocked = abs(way) < BLOCKED * abs(step)
                at_stop = math.copysign(MARGIN, sign * step) if blocked else 0.0

    def _by(self, step: float):
        """Drive on by `step` deg, in the sign of readings; how far it went."""
        bench, index = self.bench, self.index
        before, seconds = bench.mean(0.1)[index], max(0.1, abs(step) / SPEED * 1.25)
        if not bench.obeys_position[index]:
            end = bench.now + seconds
            while bench.now < end:
                move(bench, index, step / seconds, 0.1)
                yield from wait(bench, 0.05)
            yield from let_go(bench)
            yield from rest(bench, 0.2)
            return half_turn(bench.mean(0.1)[index] - before)
        sequence = bench.increment(index, bench.position_signs[index] * step, round(seconds, 1))
        yield from wait(bench, seconds, f"{self.name} goes on")
        yield from rest(bench, 0.2)
        way, code = half_turn(bench.mean(0.1)[index] - before), bench.code(sequence)
        if abs(way) < BLOCKED * abs(step):
            found = f"is refused, with {code:#04x}" if code else "ends at the stop"
            self._beyond = self.beyond.found(found, f"sent {step:+.0f} deg, went {way:+.1f}")
        return way
