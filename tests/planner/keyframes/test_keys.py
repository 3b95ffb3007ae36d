"""Keys as waypoints, and the ramps between two rests."""

from __future__ import annotations

import pytest

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.keys import Key, ramps_asked, segment_between, waypoints
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


def test_a_ramp_at_one_end_is_one_at_both() -> None:
    points = waypoints(Axis.PAN, [Key(0, 0, leave=Ramp(seconds=1)), Key(10, 20)])
    assert ramps_asked(points) == (1, 1)
    points = waypoints(Axis.PAN, [Key(0, 0, leave=Ramp(seconds=1)), Key(10, 20, arrive=Ramp(share=0.25))])
    assert ramps_asked(points) == (1, 2.5)


def test_an_axis_that_stands_still_has_no_ramps() -> None:
    assert ramps_asked(waypoints(Axis.PAN, [Key(0, 5, leave=Ramp(seconds=1)), Key(10, 5)])) is None
    assert ramps_asked(waypoints(Axis.PAN, [Key(0, 5), Key(10, 6)])) is None


def test_a_ramp_is_never_shorter_than_its_change_of_speed_needs() -> None:
    points = waypoints(Axis.PAN, [Key(0, 0), Key(4, 100)])
    short = segment_between(points, (0.01, 3.0), LIMITS)
    assert short.ramps is not None
    leave, arrive = short.ramps
    assert arrive == 3.0
    assert leave >= quickest(100 / 4, LIMITS)
    assert segment_between(points, None, LIMITS).ramps is None


def test_all_times_of_a_key_are_multiplied() -> None:
    key = Key(2, 5, hold=1, arrive=Ramp(seconds=0.5), leave=Ramp(share=0.25)).later(3)
    assert (key.at, key.position, key.hold) == (6, 5, 3)
    assert (key.arrive, key.leave) == (Ramp(seconds=1.5), Ramp(share=0.25))
