"""An axis from pass to pass: what is better is kept, what is worse is dropped, and learning ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from teleop.core.axes import Axis, Limits
from teleop.learning.axis_learner import AxisLearner
from teleop.learning.correction import Correction, Error
from teleop.planner.offset_track import added
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Track

LIMITS = Limits(-90.0, 90.0, 120.0, 240.0, 1200.0)
PLAN = Track.through(np.array([0.0, 2.0, 4.0]), np.array([[0.0, 30, 0], [0, 0, 0], [0, 0, 0]]))
TIMES = np.arange(0.0, 4.0, 0.04)


def learner() -> AxisLearner:
    return AxisLearner(PLAN, LIMITS, [-0.3, 4.3], None)


def late(offset: Track, seconds: float = 0.1) -> tuple[Array, Array]:
    return TIMES, added(PLAN, offset).sample(TIMES - seconds)[0]


def error(readings: tuple[Array, Array]) -> Error:
    left = PLAN.sample(readings[0])[0] - readings[1]
    return Error(len(left), float(np.sqrt(np.mean(left**2))), float(np.abs(left).max()), 0.0)


def test_a_gimbal_that_is_late_is_sent_early():
    learns = learner()
    first = late(learns.offset)
    learns.learn(1, error(first), first)
    second = late(learns.offset)
    assert error(second).rms < 0.05 * error(first).rms
    assert learns.offset.at(-0.1).position != 0  # it begins before the move does


def test_a_pass_that_is_worse_is_dropped_and_the_best_is_kept():
    learns = learner()
    first = late(learns.offset)
    learns.learn(1, error(first), first)
    tried = learns.offset
    learns.learn(2, Error(1, 9.0, 9.0, 0.0), first)
    assert (learns.best_pass, learns.ended) == (1, "")
    assert not learns.best.coefficients.any()
    times = np.linspace(0, 4, 50)
    assert learns.offset.sample(times)[0] == pytest.approx(tried.sample(times)[0] / 2, abs=1e-9)
    learns.learn(3, Error(1, 9.0, 9.0, 0.0), first)
    assert learns.ended == "it does not help any more"
    assert not learns.offset.coefficients.any()


def test_a_pass_that_was_not_settled_corrects_nothing_and_may_yet_be_the_best():
    learns = learner()
    lucky, usual = late(learns.offset, 0.02), late(learns.offset)
    learns.learn(1, error(lucky), lucky, settled=False)
    assert not learns.offset.coefficients.any()
    learns.learn(2, error(usual), usual)
    assert learns.best_pass == 1
    corrected = late(learns.offset)
    assert error(corrected).rms < 0.05 * error(usual).rms
    learns.learn(3, error(corrected), corrected)
    assert learns.best_pass == 3
    assert learns.best.coefficients.any()


def test_learning_ends_where_there_is_nothing_to_gain():
    learns = learner()
    noise = np.random.default_rng(0).uniform(-0.05, 0.05, len(TIMES))
    readings = TIMES, PLAN.sample(TIMES)[0] + noise
    learns.learn(1, error(readings), readings)
    assert learns.ended == "there is nothing more to gain"
    assert not learns.offset.coefficients.any()


def test_a_hand_on_an_axis_that_rests_does_not_move_it_later():
    rests = Track.through(np.array([0.0, 1.0, 5.0, 6.0]), np.array([[0.0, 10, 10, 0], [0] * 4, [0] * 4]))
    learns = AxisLearner(rests, LIMITS, [-0.3, 6.3], None)
    times = np.arange(0.0, 6.0, 0.04)
    held = rests.sample(times)[0] - 8 * np.exp(-(((times - 3) / 0.2) ** 2))
    learns.learn(1, Error(len(times), 2.0, 8.0, 3.0), (times, held))
    still = np.linspace(1.8, 4.2, 100)
    assert np.abs(learns.offset.sample(still)[0]).max() <= 0.2 + 1e-6


def test_what_was_learned_before_is_where_it_begins():
    learns = learner()
    first = late(learns.offset)
    learns.learn(1, error(first), first)
    again = AxisLearner(PLAN, LIMITS, [-0.3, 4.3], learns.offset)
    times = np.linspace(-0.3, 4.3, 200)
    assert again.offset.sample(times)[0] == pytest.approx(learns.offset.sample(times)[0], abs=1e-6)


def test_a_correction_that_takes_an_axis_beyond_its_limits_is_noticed():
    learns = learner()
    first = late(learns.offset)
    learns.learn(1, error(first), first)
    move, peak = Move({Axis.PAN: PLAN}), added(PLAN, learns.offset).peaks().acceleration
    found = Correction("Rig", "Move", "ab", {Axis.PAN: learns.offset}, {Axis.PAN: 1}, [])
    assert found.exceeds(move, {Axis.PAN: LIMITS}) == []
    assert found.exceeds(move, {Axis.PAN: replace(LIMITS, acceleration=peak - 1)}) == [Axis.PAN]
