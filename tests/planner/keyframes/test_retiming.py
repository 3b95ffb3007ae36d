"""Keys with more time between some of them move all later keys of all axes along."""

from __future__ import annotations

import pytest

from teleop.core.axes import Axis
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.legs import legs
from teleop.planner.keyframes.retiming import Way, retimed, ways

PAN, TILT = Axis.PAN, Axis.TILT
KEYS = {PAN: [Key(0, 0), Key(2, 10, hold=1), Key(4, 20)], TILT: [Key(0, 0), Key(3.5, 5), Key(4, 6)]}


def times(keys, needs):
    return {axis: [key.at for key in of_axis] for axis, of_axis in retimed(keys, needs).items()}


def test_a_longer_way_moves_all_that_is_later() -> None:
    assert times(KEYS, {Way(PAN, 0, 1): 3.0}) == {PAN: [0, 3, 5], TILT: [0, 4.5, 5]}


def test_the_longest_need_decides_and_nothing_becomes_shorter() -> None:
    assert times(KEYS, {Way(PAN, 1, 2): 1.5, Way(TILT, 1, 2): 0.1}) == {PAN: [0, 2, 4.5], TILT: [0, 3.5, 4.5]}
    assert times(KEYS, {Way(TILT, 0, 1): 4.0, Way(PAN, 0, 1): 2.5})[TILT] == [0, 4.0, 4.5]


def test_the_ways_of_a_leg_are_between_its_keys() -> None:
    found = [ways(PAN, KEYS[PAN], leg) for leg in legs(PAN, KEYS[PAN])]
    assert found == [[Way(PAN, 0, 1)], [], [Way(PAN, 1, 2)]]


@pytest.mark.parametrize("later", [0.0, 3e-17])
def test_a_key_where_a_hold_ends_begins_the_next_way(later: float) -> None:
    keys = [Key(0, 0), Key(2, 10, hold=1), Key(3 + later, 10), Key(5, 20)]
    assert ways(PAN, keys, legs(PAN, keys)[-1]) == [Way(PAN, 2, 3)]
