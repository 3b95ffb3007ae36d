"""The keys of a planned move are read from how its jerk changes."""

from __future__ import annotations

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.planner import Key, plan
from teleop.recording.to_keyframes.knots import knots, planned_keys

LIMITS = Limits(-100, 100, 120, 240, 1200)


def test_the_keys_of_a_move_of_even_speed_are_found_exactly() -> None:
    keys = [Key(0, 0), Key(2, 20), Key(3.5, 35), Key(6, 50), Key(8, 40), Key(11, 70), Key(13, 82)]
    move = plan({Axis.PAN: keys}, {Axis.PAN: LIMITS})
    acceleration = move.sample(np.arange(1301) / 100)[Axis.PAN][2]
    assert list(planned_keys(knots(acceleration), 0, 1300)) == [200, 350, 600, 800, 1100]


def test_a_hand_has_no_knots() -> None:
    noise = np.random.default_rng(1).normal(0, 1, 2000)
    assert knots(noise) == []
    assert knots(np.zeros(2)) == []
