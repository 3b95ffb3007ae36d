"""Few keys for one axis between two rests."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.fit import MARGIN, SampledSegment, Style, fit, turning_points
from teleop.planner.keyframes.planner import Key, plan

LIMITS = Limits(-100, 100, 120, 240, 1200)


def recorded(*keys: Key, allowed: float = 0.2) -> SampledSegment:
    move = plan({Axis.PAN: list(keys)}, {Axis.PAN: LIMITS})
    positions = move.sample(np.arange(round(move.duration * 100) + 1) / 100)[Axis.PAN][0]
    return SampledSegment(0, positions, Style(Axis.PAN, LIMITS, allowed, 3, "even", 100, 3))


def test_a_move_from_rest_to_rest_needs_its_two_ends() -> None:
    found = fit(recorded(Key(0, 0), Key(3, 40)), [], [])
    assert found.keys == {0: 0.0, 300: 40.0}


def test_a_turn_is_a_key_and_the_plan_is_as_near_as_allowed() -> None:
    segment = recorded(Key(0, 0), Key(2, 40), Key(5, -10))
    found = fit(segment, [], [])
    assert found.off is not None
    assert np.abs(found.off).max() <= MARGIN * segment.style.allowed
    assert len(found.keys) == 3
    assert min(abs(place - 200) for place in found.keys) <= 3


def test_a_smaller_tolerance_needs_no_fewer_keys() -> None:
    keys = Key(0, 0), Key(1.5, 30), Key(2.5, 35), Key(5, -10), Key(7, 0)
    counts = [len(fit(recorded(*keys, allowed=allowed), [], []).keys) for allowed in (2.0, 0.2, 0.05)]
    assert counts == sorted(counts)


def test_what_the_limits_cannot_follow_has_no_keys_that_are_good_enough() -> None:
    segment = recorded(Key(0, 0), Key(2, 80))
    slow = SampledSegment(0, segment.positions, Style(Axis.PAN, LIMITS.scaled(0.1), 0.2, 3, "even", 100, 3))
    assert fit(slow, [], []).off is None


@pytest.mark.parametrize(
    ("positions", "turns"),
    [([0, 1, 2, 3], []), ([0, 5, 0, 5], [1, 2]), ([0, 5, 4.95, 6], []), ([5, 5, 5], []), ([0, -5, 5, 4], [1, 2])],
)
def test_turning_points_are_extremes_and_not_noise(positions: list[float], turns: list[int]) -> None:
    assert list(turning_points(np.array(positions, float), 0.2)) == turns
