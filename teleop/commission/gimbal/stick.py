"""Pushes of the gimbal's joystick (0E 0A) for one angle: the smallest for 0.1 s, measured before more."""

from __future__ import annotations

from teleop.commission.findings import Findings, Subject
from teleop.commission.gimbal.base import AxisStep, direction_question
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import FURTHEST, home, lapse, less, pulse
from teleop.commission.gimbal.signs import seen_angle, settle_order, sign_facts, sign_subjects
from teleop.commission.step import Script
from teleop.dji.gimbal.joystick import FULL_DEFLECTION as FULL

FIRST, BRIEF = 1, 0.1  # the smallest push, and s
SEEN = 0.2  # deg in that time that are no more noise
SPEED = 3.0  # deg/s of the push that is measured
LONG, LEAST = 1.0, 1.2  # s of it, and deg that it is to go at least


class StickStep(AxisStep):
    """Pushes that grow, each measured before the next."""

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench, index)
        name = self.name
        self.key, self.title = f"stick-{name}", f"Joystick (0x0A): {name}"
        self.about = (
            f"The smallest push there is moves {name} for {BRIEF:g} s. It is measured; then",
            "the push grows, each time only as far as the last one allows.",
            f"At about {SPEED:g} deg/s it lasts {LONG:g} s, to one side and back.",
            "How fast a push is depends on a setting of the gimbal. It goes 5 deg at most.",
        )
        self.obeyed = Subject(f"stick.obeyed.{name}", f"{name} obeys pushes of the joystick (0E 0A)", True)
        self.full = Subject(f"stick.full.{name}", f"Speed of {name} at full deflection", None, "deg/s")
        self.least = Subject(f"stick.least.{name}", f"The smallest push that moves {name} in 0.1 s", None, "of 15000")
        self.holds = Subject(f"stick.holds.{name}", f"How long a push of {name} holds", None, "s")
        self.signs = sign_subjects(name)
        self.subjects = (self.obeyed, self.signs.stick, self.full, self.least, self.holds)

    def script(self, findings: Findings) -> Script:
        bench, index = self.bench, self.index
        bench.allow(FURTHEST)
        push, moved = yield from self._grow()
        main = seen_angle(bench, moved, index, SEEN)
        if main is None:
            return [self.obeyed.found(False, "it did not move at full deflection for 0.1 s")]
        facts = settle_order(bench, self.signs.order, index, main)
        facts += [
            self.obeyed.found(True, f"a push of {push} for {BRIEF:g} s moved it {abs(moved[main]):.1f} deg"),
            self.least.found(push, f"moved it {abs(moved[main]):.1f} deg in {BRIEF:g} s"),
        ]
        rough = moved[main] / BRIEF / push * FULL  # deg/s at full deflection, in the sign of readings
        bench.full_stick[index] = rough
        push = max(1, min(FULL, round(min(2.0 * push, SPEED / abs(rough) * FULL))))
        while abs(there := (yield from self._go(push))) < LEAST and push < FULL:
            push = min(FULL, 2 * push)
            yield from home(bench)
        yield from home(bench)
        back = yield from self._go(-push)
        full = bench.full_stick[index] = (there - back) / 2 / LONG / push * FULL
        how = f"pushes of {push} for {LONG:g} s, both ways"
        facts.append(self.full.found(round(abs(full), 1), how))
        report = findings.value(self.signs.report.key)
        if not isinstance(report, int | float):
            report, seen = yield from self._direction(-push, back)
            facts += seen
        facts.append(self.signs.stick.found(int(report) * (1 if full > 0 else -1), how))
        yield from home(bench)
        facts += yield from self._lapse(push, full)
        yield from home(bench)
        return facts

    def _grow(self):
        """The push that was first seen to move it, and how far; each is measured before the next."""
        bench, push = self.bench, FIRST
        nothing = yield from pulse(bench, 0, BRIEF, self._send, "push 0: it should not move")
        while True:
            if max(map(abs, bench.ways_back().values()), default=0.0) > 1.0:
                yield from home(bench)
            moved = less((yield from pulse(bench, push, BRIEF, self._send, f"push {push}")), nothing)
            furthest = abs(moved[self.index]) if bench.knows_order else max(map(abs, moved))
            if furthest >= SEEN + bench.noise / 2 or push == FULL:
                return push, moved
            push = min(FULL, push * (4 if furthest < SEEN / 3 else 2))

    def _send(self, value: float) -> None:
        self.bench.push(self.index, round(value))

    def _go(self, push: int):
        """How far it goes in the time of the long push."""
        return (yield from pulse(self.bench, push, LONG, self._send, f"push {push}"))[self.index]

    def _direction(self, push: int, moved: float):
        """The operator has seen a `push` that moved the reading by `moved`; where that was unclear, it is repeated."""
        while (seen := (yield direction_question(self.name))) == "u":
            yield from home(self.bench)
            moved = yield from self._go(push)
        report = (1 if moved > 0 else -1) * (1 if seen == "y" else -1)
        return report, sign_facts(self.bench, self.signs, self.index, report)

    def _lapse(self, push: int, full: float) -> Script:
        bench, index = self.bench, self.index
        done = yield from lapse(bench, index, push, 0.4, self._send)
        speed = abs(full) * push / FULL
        if not done.stopped or speed < 0.2:
            how = f"it went on for {done.went:.1f} deg, and was stopped"
            return [self.holds.found(None, how, different=True)]
        how = f"left to lapse: it went {done.went:.1f} deg at {speed:.1f} deg/s"
        return [self.holds.found(round(done.went / speed - done.sent, 2), how)]
