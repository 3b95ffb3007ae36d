"""The rhythm of a sink: its own rate on the loop's grid, and the one tick that does not wait for it."""

from __future__ import annotations

import pytest

from teleop.core.axes import Axis, State
from teleop.devices.rate_divider import RateDivider

REST, MOVING = {Axis.PAN: State(1.0)}, {Axis.PAN: State(1.0, 0.0, 3.0)}


def served(rate: float, moving: set[int], ticks: int = 40) -> list[int]:
    pace = RateDivider(rate)
    return [tick for tick in range(ticks) if pace.due(100 + tick / 100, MOVING if tick in moving else REST)]


@pytest.mark.parametrize(("rate", "every"), [(100, 1), (50, 2), (25, 4), (10, 10)])
def test_every_so_manieth_tick_from_the_first_on(rate: float, every: int) -> None:
    assert served(rate, set()) == list(range(0, 40, every))
    assert served(rate, set(range(40))) == list(range(0, 40, every))


@pytest.mark.parametrize("start", range(4, 8))
def test_what_starts_to_move_is_told_at_once_and_the_rhythm_goes_on_from_there(start: int) -> None:
    assert served(25, set(range(start, 40))) == [0, *range(4, start, 4), *range(start, 40, 4)]


def test_a_pause_leaves_no_debt() -> None:
    pace = RateDivider(50)
    assert [pace.due(now) for now in (1.0, 1.01, 2.0, 2.01, 2.02)] == [True, False, True, False, True]
