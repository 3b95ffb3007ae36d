"""The test move of a calibration."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from teleop.app.calibration.calibration_move import REST, SHARE, CalibrationMove
from teleop.core.axes import Axis, Limits, State
from teleop.core.errors import DeviceError, UsageError
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import StateTarget

LIMITS = Limits(-90, 90, 60, 120, 600)
AT_REST = Feedback({Axis.PAN: State(0)}, {})


def started(at=0.0, limits=LIMITS):
    move = CalibrationMove(Axis.PAN, limits, 6, 6)
    move.start(10.0, {Axis.PAN: State(at)})
    return move


def states(move: CalibrationMove) -> list[StateTarget]:
    times = [10 + 0.01 * tick for tick in range(round(100 * (2 * REST + move.duration)))]
    setpoints = [move.read(time, AT_REST)[0][Axis.PAN] for time in times]
    return [each for each in setpoints if isinstance(each, StateTarget)]


def test_it_swings_to_one_side_and_back_to_rest():
    found = states(started(at=5))
    assert (found[0].position, found[-1].position) == pytest.approx((5, 5))
    assert max(state.position for state in found) == pytest.approx(11, abs=0.1)
    assert min(state.position for state in found) == pytest.approx(5, abs=1e-6)


def test_it_uses_no_more_than_its_share_of_the_limits():
    found = states(started())
    jerks = [(after.acceleration - before.acceleration) / 0.01 for before, after in pairwise(found)]
    assert max(abs(state.velocity) for state in found) <= SHARE * LIMITS.velocity
    assert max(abs(state.acceleration) for state in found) <= SHARE * LIMITS.acceleration
    assert max(map(abs, jerks)) <= LIMITS.jerk


def test_near_a_limit_it_swings_to_the_other_side():
    found = states(started(at=88))
    assert min(state.position for state in found) == pytest.approx(82, abs=0.1)


def test_without_room_it_does_not_start():
    with pytest.raises(DeviceError, match="no room"):
        started(limits=Limits(-3, 3, 60, 120, 600))


def test_limits_that_are_too_low_are_refused():
    with pytest.raises(UsageError, match="too low"):
        CalibrationMove(Axis.PAN, Limits(-90, 90, 0.1, 120, 600), 6, 6)


def test_after_a_stop_it_begins_again():
    move = started()
    move.suspend(12.0)
    assert move.begin == math.inf
    move.resume(20.0, {Axis.PAN: State(1)})
    assert move.begin == 20.0 + REST
