"""When a whole move rests."""

from math import inf

import pytest

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.keyframes.rests import Rest, rests
from teleop.planner.trajectory import Move

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-56, 146, 60, 120, 600)}


def planned(**keys: list[Key]) -> Move:
    return plan({Axis(name): of_axis for name, of_axis in keys.items()}, LIMITS)


def test_stops_dwells_and_what_lies_around_the_move_are_rests_of_one_axis() -> None:
    move = planned(pan=[Key(1, 0), Key(4, 20, stop=True), Key(8, 40, hold=2), Key(14, 0)])
    assert rests(move) == [Rest(-inf, 1), Rest(4, 4), Rest(8, 10), Rest(14, inf)]


def test_all_axes_must_rest() -> None:
    move = planned(pan=[Key(0, 0), Key(4, 20, hold=3), Key(10, 40)], tilt=[Key(2, 0), Key(5, 5, hold=4), Key(12, 0)])
    assert rests(move) == [Rest(-inf, 0), Rest(5, 7), Rest(12, inf)]


def test_a_stop_of_one_axis_counts_within_the_rest_of_another() -> None:
    move = planned(pan=[Key(0, 0), Key(4, 20, stop=True), Key(10, 40)], tilt=[Key(0, 0), Key(2, 5, hold=4), Key(10, 0)])
    assert rests(move)[1] == Rest(4, 4)


def test_a_key_passed_through_and_the_turn_of_a_bounce_are_none() -> None:
    move = planned(pan=[Key(0, 0), Key(3, 20), Key(6, 40), Key(9, 20), Key(12, 0)])
    assert rests(move) == [Rest(-inf, 0), Rest(12, inf)]


def test_an_axis_with_one_key_rests_always() -> None:
    assert rests(planned(pan=[Key(3, 7)])) == [Rest(-inf, inf)]


@pytest.mark.parametrize("time", [0.0, 4.0, 8.0])
def test_what_is_called_a_rest_is_one(time: float) -> None:
    move = planned(
        pan=[Key(0, 0), Key(4, 20, stop=True), Key(8, 40)], tilt=[Key(0, 3), Key(4, 9, stop=True), Key(8, 1)]
    )
    assert any(rest.start <= time <= rest.end for rest in rests(move))
    for state in move.at(time).values():
        assert state[1:] == pytest.approx((0, 0), abs=1e-5)
