"""Slow swings at speeds, by which the estimator of the closed loop finds dead time, lag, gain and drift."""

from __future__ import annotations

import math
from collections.abc import Generator

from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import home, let_go, rest
from teleop.commission.gimbal.places import gone
from teleop.commission.step import Pause, Question, Wait
from teleop.config.wiring import half_turn
from teleop.core.axes import Reading
from teleop.core.response import Response
from teleop.identification.candidates import Start
from teleop.identification.estimator import ResponseEstimator

REACH, PERIOD, SWINGS = 2.5, 2.0, 8  # deg to one side, s, and how many
PACE = 0.02  # s between two speeds
PULL = 1.0  # 1/s: how fast a drift is taken back
FASTEST = 4.5  # deg/s
STRAY = 2.0  # deg that another angle may drift off meanwhile, before all go back
LONGEST = 90.0  # s with all the ways back
UNKNOWN = Start(gain_doubt=0.15, gains=(0.3, 3.0))


class Swings:
    """`sign` is that of a speed against the reading, `gain` what a speed is known to be multiplied by, at least."""

    def __init__(self, bench: GimbalBench, index: int, sign: int, gain: float) -> None:
        self._bench, self._index, self._sign, self._gain = bench, index, sign, gain
        self._estimator = ResponseEstimator(None, UNKNOWN)
        self._read = bench.now

    def script(self) -> Generator[Wait | Question, str, Response | None]:
        """Swings, then the response; None where it is not sure."""
        bench, swung, end = self._bench, 0.0, self._bench.now + LONGEST
        while swung < PERIOD * SWINGS and bench.now < end:
            begin = bench.now
            yield from self._swing(PERIOD * SWINGS - swung)
            swung += bench.now - begin
            yield from let_go(bench)
            self._estimator.sent(bench.now, 0.0)
            yield from rest(bench, 0.1)
            yield from home(bench)
        return self._estimator.response if self._estimator.sure else None

    def _swing(self, seconds: float) -> Pause:
        """For so long, or until another angle has drifted off."""
        bench, index = self._bench, self._index
        before, began, self._read = bench.mean(), bench.now, bench.now
        while (elapsed := bench.now - began) < seconds:
            for each in bench.since(self._read):
                self._read = each.time
                place = before[index] + half_turn(each.angles[index] - before[index])
                self._estimator.read(Reading(place, each.time))
            here = bench.mean(0.06)
            ways = [abs(way) for each, way in enumerate(gone(before, here)) if each != index]
            if max(ways) > STRAY:
                return
            speed = round(self._speed(elapsed, half_turn(here[index] - before[index])), 1)
            bench.speed(index, self._sign * speed)
            self._estimator.sent(bench.now, speed)
            yield Wait(PACE, f"{bench.name(index)} swings, {seconds - elapsed:.0f} s left")

    def _speed(self, elapsed: float, off: float) -> float:
        """In the sign of readings: the swing's own, and what pulls a drift back; never above what is allowed."""
        rate = 2 * math.pi / PERIOD
        place = REACH * (1 - math.cos(rate * elapsed)) / 2
        speed = REACH * rate * math.sin(rate * elapsed) / 2 + PULL * max(-1.0, min(1.0, place - off))
        return max(-FASTEST, min(FASTEST, speed)) / self._gain
