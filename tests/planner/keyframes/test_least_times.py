"""The least durations do, and less of any one does not."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.core.axes import Limits
from teleop.planner.keyframes.bounds import rest_to_rest
from teleop.planner.keyframes.least_times import Window, least_durations
from teleop.planner.keyframes.program import Rule
from teleop.planner.keyframes.qp import solve
from teleop.planner.keyframes.segment import Segment

LIMITS = Limits(-170, 170, 60, 120, 600)
FINEST = Rule(8, directed=False, fine=True)


def segment(durations, positions) -> Segment:
    return Segment(np.concatenate([[0.0], np.cumsum(durations)]), np.array(positions, float))


def test_one_way_takes_as_long_as_the_time_optimal_step() -> None:
    window = Window(segment([0.3], [0, 20]), LIMITS, np.array([0]))
    assert least_durations(window, np.array([1.0])) == pytest.approx(rest_to_rest(20, LIMITS), rel=0.01)


def test_each_duration_is_least_beside_the_others() -> None:
    asked, positions = np.array([0.4, 0.5, 2.0]), [0, 40, 10, 25]
    found = least_durations(Window(segment(asked, positions), LIMITS, np.arange(3)), 2 * asked)
    assert found is not None
    assert solve(segment(1.01 * found, positions), LIMITS, FINEST) is not None
    for interval in np.flatnonzero(found > 1.001 * asked):
        less = 1.01 * found
        less[interval] = max(asked[interval], 0.95 * found[interval])
        assert solve(segment(less, positions), LIMITS, FINEST) is None
    assert (found >= asked).all()


def test_twins_last_the_same() -> None:
    window = Window(segment([0.4, 0.4, 0.4], [0, 30, 0, 30]), LIMITS, np.array([0, 0, 0]))
    found = least_durations(window, np.full(3, 1.0))
    assert found is not None
    assert found.tolist() == [found[0]] * 3


def test_a_window_is_passed_at_speed_where_its_ends_are_open() -> None:
    at_rest = Window(segment([0.2], [0, 20]), LIMITS, np.array([0]))
    passing = at_rest._replace(open_ends=(True, True))
    guess = np.array([1.0])
    assert least_durations(passing, guess) == pytest.approx(20 / 57, rel=0.01)
    assert (least_durations(at_rest, guess) > 2 * least_durations(passing, guess)).all()  # type: ignore[operator]


def test_an_overshoot_is_kept_within_what_is_tolerated() -> None:
    tight = Window(segment([2.0, 0.3, 2.0], [0, 1, 14, 15]), LIMITS, np.arange(3))
    free = least_durations(tight, np.array([2.0, 0.6, 2.0]))
    kept = least_durations(tight._replace(stray=np.full(3, 0.01)), np.array([2.0, 0.6, 2.0]))
    assert free is not None
    assert kept is not None
    assert kept.sum() >= free.sum() - 1e-3
