"""Warnings of a planned segment: overshoots that show, ramps that became longer."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.core.axes import Axis
from teleop.planner.keyframes.diagnostics import LATE, VISIBLE, long_ramps, overshoots, standstills
from teleop.planner.keyframes.segment import Segment

NAMES = ["key 1", "key 2", "key 3"]
SEGMENT = Segment(np.array([0.0, 1, 2]), np.array([0.0, 10, 10]))


def parabola(height: float) -> np.ndarray:
    """From 10 up by `height` and back within a second."""
    return np.array([10, 4 * height, -4 * height, 0, 0, 0])


@pytest.mark.parametrize(("height", "found"), [(0.5, [0.5]), (-0.5, [0.5]), (0.9 * VISIBLE, [])])
def test_an_overshoot_is_how_far_the_range_of_its_two_keys_is_left(height: float, found: list[float]) -> None:
    coefficients = np.array([[0, 10, 0, 0, 0, 0], parabola(height)], float)
    reported = overshoots(Axis.PAN, SEGMENT, NAMES, np.array([1.0, 1.0]), coefficients)
    assert [each.size for each in reported] == pytest.approx(found)
    assert [(each.first, each.last) for each in reported] == [("key 2", "key 3")] * len(found)


def test_a_ramp_is_reported_where_it_is_clearly_longer_than_asked() -> None:
    just = 0.5 / LATE * 1.001
    segment = Segment(SEGMENT.times, SEGMENT.positions, ramps(0.5, 0.5))
    assert [each.last for each in long_ramps(Axis.PAN, segment, NAMES, ramps(0.1, just))] == ["key 1"]
    assert long_ramps(Axis.PAN, segment, NAMES, ramps(0.0, 0.5)) == []


def ramps(leave: float, arrive: float) -> np.ndarray:
    return np.array([[0, leave], [0, 0], [arrive, 0]])


def test_an_interval_that_is_almost_at_rest_for_long_is_reported_once() -> None:
    still = Segment(np.array([0.0, 1, 2, 3]), np.array([0.0, 10, 10.1, 20]))
    coefficients = np.array([[0, 10, 0, 0, 0, 0], [10, 0, 0, 0, 0, 0.1], [10.1, 9.9, 0, 0, 0, 0]])
    names = ["key 1", "key 2", "key 1", "key 2"]
    (found,) = standstills(Axis.PAN, still, names, np.ones(3), coefficients)
    assert (found.first, found.last) == ("key 2", "key 1")
    assert found.seconds == pytest.approx(0.25, abs=0.07)  # 5 u^4 below 2 % of the mean
    assert str(found).startswith("pan almost stops for 0.")
