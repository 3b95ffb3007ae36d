"""Keys as waypoints, and the ramps between two rests."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.keys import Key, Waypoint, ramps_asked, segment_between, waypoints
from teleop.planner.keyframes.ramp import Ramp, quickest

LIMITS = Limits(-170, 170, 60, 120, 600)


def test_a_hold_is_two_rests_and_both_ends_are_rests() -> None:
    points = waypoints(Axis.PAN, [Key(0, 0), Key(2, 10, hold=1), Key(4, 20), Key(6, 30)])
    assert [(point.time, point.rest) for point in points] == [
        (0, True),
        (2, True),
        (3, True),
        (4, False),
        (6, True),
    ]


def test_a_hold_may_end_on_a_key_at_the_same_position_only() -> None:
    points = waypoints(Axis.PAN, [Key(0, 0), Key(2, 10, hold=1), Key(3, 10), Key(6, 30)])
    assert [point.time for point in points] == [0, 2, 3, 6]
    with pytest.raises(PlanError, match=r"pan: key 3 \(at 3 s\) is not after key 2 \(until 3 s\)"):
        waypoints(Axis.PAN, [Key(0, 0), Key(2, 10, hold=1, where="key 2"), Key(3, 11, where="key 3"), Key(6, 30)])


def both_ends(points: Sequence[Waypoint]) -> tuple[float, float]:
    asked = ramps_asked(points)
    assert asked is not None
    return asked[0, 1], asked[-1, 0]


def test_a_turn_has_ramps_on_both_sides_and_a_key_passed_through_none() -> None:
    keys = [Key(0, 0, leave=Ramp(2.0)), Key(5, 20), Key(10, 50, leave=Ramp(1.0)), Key(20, 0)]
    asked = ramps_asked(waypoints(Axis.PAN, keys))
    assert asked is not None
    assert asked.tolist() == [[0, 2], [0, 0], [2, 1], [2, 0]]


def test_ramps_that_meet_at_turns_have_the_time_that_there_is() -> None:
    asked = ramps_asked(waypoints(Axis.PAN, [Key(0, 0, leave=Ramp(3.0)), Key(4, 20), Key(12, 0)]))
    assert asked is not None
    assert asked.tolist() == [[0, 2], [2, 3], [3, 0]]


def test_a_ramp_at_one_end_is_one_at_both() -> None:
    points = waypoints(Axis.PAN, [Key(0, 0, leave=Ramp(seconds=1)), Key(10, 20)])
    assert both_ends(points) == (1, 1)
    points = waypoints(Axis.PAN, [Key(0, 0, leave=Ramp(seconds=1)), Key(10, 20, arrive=Ramp(share=0.25))])
    assert both_ends(points) == (1, 2.5)


def test_an_axis_that_stands_still_has_no_ramps() -> None:
    assert ramps_asked(waypoints(Axis.PAN, [Key(0, 5, leave=Ramp(seconds=1)), Key(10, 5)])) is None
    assert ramps_asked(waypoints(Axis.PAN, [Key(0, 5), Key(10, 6)])) is None


def test_a_ramp_is_never_shorter_than_its_change_of_speed_needs() -> None:
    points = waypoints(Axis.PAN, [Key(0, 0), Key(4, 100)])
    short = segment_between(points, np.array([[0, 0.01], [3.0, 0]]), LIMITS)
    assert short.ramps is not None
    leave, arrive = short.ramps[0, 1], short.ramps[1, 0]
    assert arrive == 3.0
    assert leave >= quickest(100 / 4, LIMITS)
    assert segment_between(points, None, LIMITS).ramps is None


def test_all_times_of_a_key_are_multiplied() -> None:
    key = Key(2, 5, hold=1, arrive=Ramp(seconds=0.5), leave=Ramp(share=0.25)).later(3)
    assert (key.at, key.position, key.hold) == (6, 5, 3)
    assert (key.arrive, key.leave) == (Ramp(seconds=1.5), Ramp(share=0.25))
