"""Whether axes are measured to be still, from readings on a grid of a tenth of a degree."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Reading
from teleop.timelapse.settle_detector import ENOUGH, SettleDetector


def fed(below: float | None, speed: float, seconds: float = 0.4, axis: Axis = Axis.PAN) -> SettleDetector:
    """A detector that has seen an axis turn at `speed` deg/s, 25 times a second."""
    detector = SettleDetector(below)
    for step in range(round(seconds * 25) + 1):
        detector.update({axis: Reading(speed * step / 25, step / 25)})
    return detector


@given(st.floats(0.1, 10))
def test_still_is_slower_than_the_rate_given(below: float) -> None:
    assert fed(below, 0.9 * below).reached
    assert not fed(below, 1.1 * below).reached
    assert not fed(below, -1.1 * below).reached


def test_before_it_has_seen_enough_nothing_is_still() -> None:
    assert not SettleDetector(1.0).reached
    assert not fed(1.0, 0.0, ENOUGH - 0.04).reached
    assert fed(1.0, 0.0, ENOUGH + 0.04).reached


def test_without_a_rate_only_time_tells() -> None:
    assert not fed(None, 0.0).reached


@pytest.mark.parametrize("other", [Axis.TILT, Axis.ROLL])
def test_every_axis_has_to_be_still(other: Axis) -> None:
    detector = fed(1.0, 0.0)
    for step in range(11):
        detector.update({other: Reading(step / 5, 0.4 + step / 25)})
    assert not detector.reached


def test_after_a_reset_old_readings_do_not_count_nor_does_the_same_one_twice() -> None:
    detector = fed(1.0, 0.0)
    detector.reset()
    for _ in range(10):
        detector.update({Axis.PAN: Reading(0.0, 1.0)})
    assert not detector.reached
