"""Even speed: keys on a line are passed evenly, nothing stops without a need, ramps of a bounce are ramps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.evenness import LONG
from teleop.planner.keyframes.planner import Key, attempt, plan
from teleop.planner.keyframes.ramp import Ramp
from teleop.planner.keyframes.repeat import Repeat, repeated
from tests.support.move_lp import slowest_speed_lp

PAN = Axis.PAN
SIM = {PAN: Limits(-180, 180, 120, 240, 1200)}


def keys(pairs: Sequence[tuple[float, float]]) -> list[Key]:
    return [Key(at, position, where=f"key {i}") for i, (at, position) in enumerate(pairs, 1)]


@pytest.mark.parametrize(("count", "gap", "step"), [(5, 2, 20), (4, 1, 5), (7, 10, -15), (9, 60, 8), (5, 3600, 40)])
def test_evenly_spaced_keys_on_a_line_are_passed_evenly(count: int, gap: float, step: float) -> None:
    move = plan({PAN: keys([(gap * i, step * (i - count / 2)) for i in range(count)])}, SIM)
    speed = move.sample(np.linspace(gap, gap * (count - 2), 2000))[PAN][1] / (step / gap)
    assert speed.min() > 0.95
    assert speed.max() < 1.05
    assert move.peaks()[PAN].velocity < 1.4 * abs(step) / gap


def test_two_keys_are_as_smooth_as_can_be_and_so_is_a_zigzag() -> None:
    move = plan({PAN: keys([(0, 0), (4, 40)])}, SIM)
    assert move.peaks()[PAN].velocity == pytest.approx(15 / 8 * 10, rel=0.01)
    zigzag = [(0, 0), (4, 40), (8, 0), (12, 40)]
    even, smooth = (plan({PAN: keys(zigzag)}, SIM, tension).peaks()[PAN] for tension in ("even", 0.0))
    assert even.velocity == pytest.approx(smooth.velocity, rel=0.1)


def test_slow_ways_beside_a_fast_one_do_not_stand_still() -> None:
    move = plan({PAN: keys([(0, 0), (5, 4), (10, 84), (15, 88)])}, SIM)
    speed = np.abs(move.sample(np.linspace(0, 15, 15001))[PAN][1])
    assert (speed < 0.05).mean() * 15 < 0.5  # it was 6.0 s
    assert move.standstills == ()
    smoothest = plan({PAN: keys([(0, 0), (5, 4), (10, 84), (15, 88)])}, SIM, 0.0)
    assert [(found.first, found.last) for found in smoothest.standstills] == [("key 1", "key 2"), ("key 3", "key 4")]


@pytest.mark.parametrize("seconds", [0.0, 0.5, 2.0])
@pytest.mark.parametrize("pairs", [[(0, 0), (5, 1), (10, 21)], [(0, 0), (5, 20), (10, 20.5), (15, 0)]])
def test_nor_do_they_with_an_ease(seconds: float, pairs: list[tuple[float, float]]) -> None:
    """Without this, one of four such moves stood still: for 3 of the 5 s in which they go 1 degree."""
    ease = Ramp(seconds)
    eased = [replace(key, arrive=ease, leave=ease) for key in keys(pairs)]
    assert not plan({PAN: eased}, SIM).standstills


def test_a_stop_that_is_left_is_reported() -> None:
    # half a degree in 4 s beside 48 degrees in the shortest time there is
    move = plan({PAN: keys([(0, 0), (4, 0.5), (5, 48.5), (9, 49)])}, SIM)
    found, _ = move.standstills
    assert (found.first, found.last) == ("key 1", "key 2")
    assert str(found).startswith("pan almost stops for 3.")


@st.composite
def one_way_moves(draw: st.DrawFn) -> list[tuple[float, float]]:
    gaps = draw(st.lists(st.integers(1, 8), min_size=2, max_size=4))
    steps = draw(st.lists(st.integers(1, 40), min_size=len(gaps), max_size=len(gaps)))
    times, positions = np.cumsum([0, *gaps]).astype(float), np.cumsum([0, *steps]).astype(float)
    return list(zip(times.tolist(), positions.tolist(), strict=True))


@settings(max_examples=10, deadline=None)
@example([(0, 0), (5, 4), (10, 84), (15, 88)])
@example([(0, 0), (8, 1), (9, 40), (17, 41)])
@given(one_way_moves())
def test_it_stops_nowhere_that_an_independent_programme_does_not(pairs: Sequence[tuple[float, float]]) -> None:
    slowest = slowest_speed_lp(pairs, SIM[PAN], middle=1 - LONG)
    move = attempt({PAN: keys(pairs)}, SIM)
    if slowest is None or slowest < 0.25 or move is None:
        return
    assert move.standstills == ()
    for (begin, _), (end, _) in pairwise(pairs):
        third = (end - begin) / 3
        assert move.sample(np.linspace(begin + third, end - third, 50))[PAN][1].min() > 0


@pytest.mark.parametrize("ramp", [Ramp(3.0), Ramp(share=0.3)])
def test_the_ramps_of_a_bounce_are_monotone_and_between_them_it_is_even(ramp: Ramp) -> None:
    there = [Key(0, -3, arrive=ramp, leave=ramp), Key(10, 3, arrive=ramp, leave=ramp)]
    move = plan(repeated({PAN: there}, 4, Repeat.BOUNCE), SIM)
    for begin in (0, 10, 20, 30):
        speed = np.abs(move.sample(np.linspace(begin, begin + 10, 1001))[PAN][1])
        cruise = speed[500]
        assert (np.diff(speed[:300]) >= -0.01 * cruise).all()
        assert (np.diff(speed[701:]) <= 0.01 * cruise).all()
        assert speed[300:701] == pytest.approx(cruise, rel=0.02)


def test_tension_of_a_bounce_is_even_between_its_turns() -> None:
    move = plan(repeated({PAN: [Key(0, -3), Key(30, 3)]}, 6, Repeat.BOUNCE), SIM, 0.6)
    times = np.concatenate([np.linspace(begin + 3, begin + 27, 500) for begin in range(0, 180, 30)])
    speed = np.abs(move.sample(times)[PAN][1])
    assert speed.max() < 1.02 * speed.min()
