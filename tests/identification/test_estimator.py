"""One axis is identified from speeds and readings alone, and an estimate that no longer holds is dropped."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from unknown_gimbal import Drive

from teleop.core.axes import Reading
from teleop.core.response import Response
from teleop.identification.estimator import ResponseEstimator
from teleop.sim.gimbal.dynamics import Dynamics

RIGHT = Response(0.05, 0.1, 1.0, 0.0, 0.006, 0.01, 0.05)
PERIOD = 0.02  # s between two speeds; every second one is followed by a reading


def swing(time: float) -> float:
    """A move to and fro, in deg/s."""
    return 30 * math.sin(2 * math.pi * time / 3) + 15 * math.sin(2 * math.pi * time / 0.9)


class Bench:
    """An axis, its estimator and the time."""

    def __init__(self, dynamics: Dynamics, prior: Response | None = None) -> None:
        self.drive, self.estimator = Drive(dynamics, 0.0), ResponseEstimator(prior)
        self.now, self._chance = 0.0, random.Random(1)

    def go(
        self, seconds: float, speed: Callable[[float], float] = swing, noise: float = 0.0, lost: float = 0.0
    ) -> Response:
        """Move for so long, in whole ms; what is known afterwards."""
        for number in range(round(seconds / PERIOD)):
            value = round(speed(self.now), 1)
            self.estimator.sent(self.now, value)
            self.drive.speed(self.now, value)
            if number % 2 == 0 and self._chance.random() >= lost:
                place = round(self.drive.at + self._chance.gauss(0, noise), 1)
                self.estimator.read(Reading(place, self.now))
            for step in range(round(PERIOD * 1000)):
                self.drive.step(self.now + step / 1000)
            self.now += PERIOD
        return self.estimator.response


def test_nothing_is_known_before_it_moves() -> None:
    bench = Bench(Dynamics(lag=0.1))
    found = bench.go(3.0, lambda _time: 0.0)
    assert not bench.estimator.sure
    assert found.delay_doubt > 0.05
    assert found.gain == pytest.approx(1.0, abs=0.01)


@settings(max_examples=6, deadline=None)
@given(st.floats(0, 0.1), st.floats(0.03, 0.2), st.floats(0.85, 1.1), st.floats(-1, 1))
def test_it_is_identified_within_its_doubt(dead_time: float, lag: float, gain: float, drift: float) -> None:
    bench = Bench(Dynamics(dead_time=dead_time, lag=lag, gain=gain, drift=drift))
    found = bench.go(4.0)
    assert bench.estimator.sure
    assert found.delay == pytest.approx(dead_time + lag, abs=0.015)
    assert found.gain == pytest.approx(gain, abs=0.03)
    assert found.drift == pytest.approx(drift, abs=0.2)


@pytest.mark.parametrize(("noise", "lost"), [(0.1, 0.0), (0.0, 0.4), (0.05, 0.2)])
def test_noise_and_lost_readings_make_it_less_sure_and_no_other(noise: float, lost: float) -> None:
    bench = Bench(Dynamics(dead_time=0.04, lag=0.1))
    found = bench.go(5.0, noise=noise, lost=lost)
    assert found.delay == pytest.approx(0.14, abs=0.025)
    assert not bench.estimator.changed


def test_noise_alone_is_no_response() -> None:
    bench = Bench(Dynamics())
    found = bench.go(10.0, lambda _time: 0.0, noise=0.1)
    assert not bench.estimator.sure
    assert abs(found.drift) < 0.15
    assert not bench.estimator.changed


@pytest.mark.parametrize(
    "then", [Dynamics(lag=0.2), Dynamics(dead_time=0.1, lag=0.05), Dynamics(lag=0.05, gain=0.75)], ids=str
)
def test_another_payload_is_noticed_and_identified_anew(then: Dynamics) -> None:
    bench = Bench(Dynamics(lag=0.05))
    bench.go(4.0)
    assert bench.estimator.sure
    bench.drive.dynamics = then
    found = bench.go(6.0)
    assert bench.estimator.changed
    assert found.delay == pytest.approx(then.dead_time + then.lag, abs=0.02)
    assert found.gain == pytest.approx(then.gain, abs=0.05)


def test_a_jump_of_the_angle_is_another_gimbal() -> None:
    bench = Bench(Dynamics(lag=0.05))
    bench.go(4.0)
    bench.drive.motor = bench.drive.at = 90.0  # it was switched off and on
    bench.go(1.0, lambda _time: 0.0)
    assert bench.estimator.changed
    assert not bench.estimator.sure


@pytest.mark.parametrize("speed", [30, 60])
def test_a_payload_that_rings_is_no_other_gimbal(speed: float) -> None:
    bench = Bench(Dynamics(lag=0.04, dead_time=0.03, natural_frequency=2.0, damping=0.4))
    bench.go(4.0, lambda time: speed / 2 * math.sin(math.pi * time / 4) ** 2)
    bench.go(1.0, lambda _time: 0.0)
    assert bench.estimator.sure
    for _ in range(2):
        begin = bench.now
        bench.go(2.0, lambda time, begin=begin: -speed * min(1.0, 5 * max(0.0, min(time - begin, 1 + begin - time))))
        bench.go(2.0, lambda _time: 0.0)
    assert not bench.estimator.changed
    assert bench.estimator.sure


def test_an_axis_that_is_held_teaches_nothing() -> None:
    bench = Bench(Dynamics(lag=0.05))
    bench.go(4.0)
    bench.drive.held = True
    found = bench.go(2.0, lambda _time: 20.0)
    assert bench.estimator.changed
    assert not bench.estimator.sure
    assert found.gain >= 0.7
    assert bench.estimator.obeys(bench.now - 0.5) is False


def test_an_axis_that_goes_where_it_is_sent_obeys_though_it_is_slow() -> None:
    bench = Bench(Dynamics(lag=0.2, dead_time=0.1, gain=0.85))
    bench.go(3.0)
    assert bench.estimator.obeys(bench.now - 0.5) is True


def test_a_prior_that_holds_is_sure_sooner_and_one_of_another_gimbal_is_dropped() -> None:
    of = Dynamics(dead_time=0.05, lag=0.1)
    right, wrong, none = (Bench(of, prior) for prior in (RIGHT, Response(0, 0.03, 1, 0, 0.006), None))
    for bench in (right, wrong, none):
        bench.go(0.4)
    assert right.estimator.response.delay_doubt < none.estimator.response.delay_doubt
    assert not right.estimator.changed
    assert wrong.go(3.0).delay == pytest.approx(0.15, abs=0.015)
    assert wrong.estimator.changed


def test_a_speed_is_forgotten_after_half_a_second() -> None:
    bench = Bench(Dynamics(lag=0.05))
    bench.estimator.sent(0.0, 10.0)
    bench.estimator.read(Reading(0.0, 0.0))
    rests, _ = bench.estimator.rests(5.0, 1)
    assert 5.0 <= rests.max() <= 7.0  # 0.5 s at 10 deg/s, at the most likely gain and more
