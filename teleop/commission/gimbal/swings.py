"""Slow swings at speeds, by which the estimator of the closed loop finds dead time, lag, gain and drift."""

from __future__ import annotations

import math

from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.places import around
from teleop.commission.step import Wait
from teleop.core.axes import Reading
from teleop.identification.estimator import ResponseEstimator

REACH, PERIOD, SWINGS = 2.5, 2.0, 8  # deg to one side, s, and how many
PACE = 0.02  # s between two speeds
PULL = 1.0  # 1/s: how fast a drift is taken back
FASTEST = 4.5  # deg/s


class Swings:
    """`sign` is that of a speed against the reading, `gain` what a speed is known to be multiplied by, at least."""

    def __init__(self, bench: GimbalBench, index: int, sign: int, gain: float) -> None:
        self._bench, self._index, self._sign, self._gain = bench, index, sign, gain

    def script(self):
        """Swings, then the response; None where it is not sure."""
        bench, index = self._bench, self._index
        estimator, start, began = ResponseEstimator(), bench.mean()[index], bench.now
        read = began
        while (elapsed := bench.now - began) < PERIOD * SWINGS:
            for each in bench.since(read):
                read = each.time
                estimator.read(Reading(start + around(each.angles[index] - start), each.time))
            speed = self._speed(elapsed, start)
            bench.speed(index, self._sign * speed)
            estimator.sent(bench.now, round(speed, 1))
            yield Wait(PACE, f"{bench.name(index)} swings, {PERIOD * SWINGS - elapsed:.0f} s left")
        return estimator.response if estimator.sure else None

    def _speed(self, elapsed: float, start: float) -> float:
        """In the sign of readings: the swing's own, and what pulls a drift back; never above what is allowed."""
        rate = 2 * math.pi / PERIOD
        place = REACH * (1 - math.cos(rate * elapsed)) / 2
        off = around(self._bench.mean(0.06)[self._index] - start)
        speed = REACH * rate * math.sin(rate * elapsed) / 2 + PULL * max(-1.0, min(1.0, place - off))
        return max(-FASTEST, min(FASTEST, speed)) / self._gain
