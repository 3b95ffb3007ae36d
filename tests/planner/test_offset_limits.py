"""The limits that are shared out between a move and its trim, and their sum."""

import pytest

from teleop.core.axes import Axis, Limits, State
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.offset_limits import sequence_limits, trim_limits, trimmed

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}
KEYS = {
    PAN: [Key(0, 0), Key(2, 40), Key(4, 80, hold=1), Key(9, -30)],
    TILT: [Key(0, 0), Key(3, 35), Key(9, -20)],
}


def test_the_trim_gets_what_the_sequence_leaves():
    left = trim_limits(plan(KEYS, sequence_limits(LIMITS)), LIMITS)
    assert left[PAN].velocity == pytest.approx(15)
    assert (left[PAN].minimum, left[PAN].maximum) == pytest.approx((-140, 90), abs=1e-6)
    assert (left[TILT].minimum, left[TILT].maximum) == pytest.approx((-10, 5), abs=1e-6)


def test_the_sum_is_of_positions_velocities_and_accelerations():
    motion = {PAN: State(10, 2, 3), TILT: State(5)}
    assert trimmed(motion, {PAN: State(1, -2, 0.5)}) == {PAN: State(11, 0, 3.5), TILT: State(5)}
