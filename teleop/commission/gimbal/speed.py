"""The speed command of one angle: sign, how long it holds, dead time, lag, gain, drift, and what is left afterwards."""

from __future__ import annotations

from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.gimbal.base import AxisStep, answered, direction_question
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import FURTHEST, cruise, home, lapse, less, let_go, pulse, rest, wait
from teleop.commission.gimbal.places import gone
from teleop.commission.gimbal.signs import seen_angle, settle_order, sign_facts, sign_subjects
from teleop.commission.gimbal.swings import Swings
from teleop.commission.step import Pause, Script
from teleop.core.response import Response

PROBE, FAST = 1.0, 4.0  # deg/s
PROBE_SECONDS = 0.6
HELD = 0.5  # s for which the speed is sent, before it is left to lapse
LEFT = 0.3  # deg off its place after speed control that is more than noise


class SpeedStep(AxisStep):
    """Slow swings of 2.5 degrees to one side, and one speed that is not repeated."""

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench, index)
        name = self.name
        self.key, self.title = f"speed-{name}", f"Speed command: {name}"
        self.about = (
            f"{name} turns at {PROBE:g} deg/s for {PROBE_SECONDS:g} s.",
            f"Then it swings 2.5 deg to one side and back, 8 times, at most {FAST:g} deg/s.",
            f"Then {FAST:g} deg/s are sent for {HELD:g} s and not repeated: it should stop by",
            "itself. It goes 5 deg at most, and ends where it began.",
        )
        self.obeyed = Subject(f"speed.obeyed.{name}", f"{name} obeys speed commands (0E 01)", True)
        self.holds = Subject(f"speed.holds.{name}", f"How long a speed of {name} holds", 0.5, "s")
        self.delay = Subject(f"speed.delay.{name}", f"Dead time and lag of {name} together", None, "s")
        self.dead_time = Subject(f"speed.dead_time.{name}", f"Dead time of {name}", None, "s")
        self.lag = Subject(f"speed.lag.{name}", f"Lag of {name}", None, "s")
        self.gain = Subject(f"speed.gain.{name}", f"Speed of {name} as a share of the commanded one", 1.0)
        self.drift = Subject(f"speed.drift.{name}", f"Drift of {name} under speed control", 0.0, "deg/s")
        self.left = Subject(f"speed.left.{name}", f"Where {name} is left when control is released", 0.0, "deg")
        self.signs = sign_subjects(name)
        model = (self.delay, self.dead_time, self.lag, self.gain, self.drift)
        self.subjects = (self.obeyed, self.signs.speed, self.holds, *model, self.left)

    def script(self, findings: Findings) -> Script:
        bench, index = self.bench, self.index
        bench.allow(FURTHEST)
        moved, code = yield from self._probe()
        main = seen_angle(bench, moved, index, 0.2 + bench.noise)
        if main is None:
            return [self.obeyed.found(False, f"{answered(code)}, and it did not move at {PROBE:g} deg/s")]
        facts = settle_order(bench, self.signs.order, index, main)
        way = moved[main]  # the angle of that name from now on, if roll and pitch were exchanged
        sign = bench.speed_signs[index] = 1 if way > 0 else -1
        rough = max(1.0, abs(way) / (PROBE * PROBE_SECONDS))
        facts.append(self.obeyed.found(True, f"moved {abs(way):.1f} deg at {PROBE:g} deg/s for {PROBE_SECONDS:g} s"))
        report = findings.value(self.signs.report.key)
        if not isinstance(report, int | float):
            report, seen = yield from self._direction(sign, rough)
            facts += seen
        facts.append(self.signs.speed.found(int(report) * sign, "the reading went with or against a positive speed"))
        yield from self._center()
        response = yield from Swings(bench, index, sign, rough).script()
        facts += self._model(response)
        yield from self._center()
        facts += yield from self._lapse(sign, rough, response)
        facts += yield from self._given_back()
        yield from home(bench)
        return facts

    def _probe(self):
        """1 deg/s for a moment; how far it went."""
        bench, index = self.bench, self.index
        sent: list[int] = []

        def send(value: float) -> None:
            sent.append(bench.speed(index, value))

        nothing = yield from pulse(bench, 0.0, PROBE_SECONDS, send, "speed 0: it should not move")
        yield from home(bench)
        moved = yield from pulse(bench, PROBE, PROBE_SECONDS, send, f"{self.name} turns")
        codes = [code for code in map(bench.code, sent) if code is not None]
        return less(moved, nothing), codes[-1] if codes else None

    def _zeros(self) -> Pause:
        bench, index = self.bench, self.index
        for _ in range(3):
            bench.speed(index, 0.0)
            yield from wait(bench, 0.05)
        yield from let_go(bench)
        yield from rest(bench)

    def _direction(self, sign: int, rough: float):
        """2 deg by a speed, and which way the operator saw it go."""
        bench, index = self.bench, self.index
        while True:
            speed = 2.0 / rough
            yield from cruise(bench, speed, 1.0, lambda value: bench.speed(index, value), f"{self.name} turns 2 deg")
            yield from self._zeros()
            seen = yield direction_question(self.name)
            yield from home(bench)
            if seen != "u":
                report = sign * (1 if seen == "y" else -1)
                return report, sign_facts(bench, self.signs, index, report)

    def _center(self) -> Pause:
        yield from let_go(self.bench)
        yield from home(self.bench)

    def _model(self, response: Response | None) -> list[Fact]:
        subjects = (self.delay, self.dead_time, self.lag, self.gain, self.drift)
        if response is None:
            return [each.not_seen("the readings do not say: too few, or too noisy") for each in subjects]
        of, how = response, "by the estimator of the closed loop, from 8 swings"
        return [
            self.delay.found(round(of.delay, 3), f"{how}; doubt {of.delay_doubt:.3f} s"),
            self.dead_time.found(round(of.dead_time, 3), f"{how}; less sure than both together"),
            self.lag.found(round(of.lag, 3), f"{how}; less sure than both together"),
            self.gain.found(round(of.gain, 3), f"{how}; doubt {of.gain_doubt:.3f}", within=0.03 + of.gain_doubt),
            self.drift.found(
                round(of.drift, 2) + 0.0, f"{how}; doubt {of.drift_doubt:.2f}", within=0.1 + of.drift_doubt
            ),
        ]

    def _lapse(self, sign: int, rough: float, response: Response | None) -> Script:
        """A speed that is sent for half a second, and then no more: how far it goes says how long it held."""
        bench, index = self.bench, self.index
        speed = FAST / rough
        actual = speed if response is None else response.gain * speed + sign * response.drift
        done = yield from lapse(bench, index, speed, HELD, lambda value: bench.speed(index, value))
        if not done.stopped or actual <= 0.2:
            how = f"it went on for {done.went:.1f} deg, and was stopped"
            return [self.holds.found(None, how, different=True)]
        how = f"left to lapse: it went {done.went:.1f} deg at {actual:.1f} deg/s"
        holds = done.went / actual - done.sent
        return [self.holds.found(round(holds, 2), how, within=0.08 + bench.noise / 4)]

    def _given_back(self) -> Script:
        """What giving back control does to the place of the angle."""
        bench, index = self.bench, self.index
        yield from cruise(bench, 0.0, 0.2, lambda value: bench.speed(index, value))
        before = bench.mean(0.15)
        yield from let_go(bench)
        yield from rest(bench)
        left = gone(before, bench.mean())[index]
        return [
            self.left.found(round(left, 1) + 0.0, "before and after control was released", within=LEFT + bench.noise)
        ]
