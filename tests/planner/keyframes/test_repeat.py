"""Repeated moves go on through their turns."""

import numpy as np
import pytest

from teleop.core.axes import Axis, Limits, State
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.keyframes.repeat import Repeat, repeated

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}


def test_a_bounce_is_the_same_way_back_and_turns_without_a_pause():
    keys = {PAN: [Key(1, 0), Key(3, 15), Key(5, 40)]}
    move = plan(repeated(keys, 3, Repeat.BOUNCE), LIMITS)
    assert move.duration == 13
    for time, position in [(1, 0), (3, 15), (5, 40), (7, 15), (9, 0), (11, 15), (13, 40)]:
        assert move.at(time)[PAN].position == pytest.approx(position, abs=1e-9)
    turn = move.at(5)[PAN]
    assert turn.velocity == pytest.approx(0, abs=1e-9)
    assert turn.acceleration < -1  # on its way back already
    assert move.overshoots == ()


def test_a_loop_passes_its_seam_at_speed():
    keys = {PAN: [Key(0, 0), Key(2, 40), Key(4, 0), Key(6, -40), Key(8, 0)]}
    move = plan(repeated(keys, 2, Repeat.LOOP), LIMITS)
    assert move.duration == 16
    assert move.at(8)[PAN].velocity > 10
    before, after = move.sample(np.array([8 - 1e-9, 8 + 1e-9]))[PAN][1:3].T
    assert before == pytest.approx(after, abs=1e-5)


def test_a_hold_or_stop_at_the_turn_stays_one():
    keys = {PAN: [Key(0, 0), Key(4, 40, hold=1)], TILT: [Key(0, 0), Key(5, 20, stop=True)]}
    move = plan(repeated(keys, 2, Repeat.BOUNCE), LIMITS)
    assert move.duration == 10
    assert move.at(4)[PAN] == move.at(5.5)[PAN] == State(40)
    assert move.at(5)[TILT] == State(20)


def test_an_axis_that_ends_early_waits_for_the_others():
    keys = {PAN: [Key(0, 0), Key(6, 40)], TILT: [Key(1, 0), Key(3, 20)]}
    move = plan(repeated(keys, 2, Repeat.BOUNCE), LIMITS)
    assert move.at(4)[TILT] == move.at(8)[TILT] == State(20)
    assert move.at(11.5)[TILT] == State(0)


def test_a_loop_that_does_not_close_is_refused():
    with pytest.raises(PlanError, match=r"pan, key 2: a loop must end where it began, at 0, not 5"):
        repeated({PAN: [Key(0, 0), Key(1, 5, where="key 2")]}, 2, Repeat.LOOP)


def test_once_is_the_move_itself():
    keys = {PAN: [Key(0, 0), Key(1, 5)]}
    assert repeated(keys, 1, Repeat.BOUNCE) == keys
