"""Segments: their parts, windows, stretches, and the cuts where ramps end."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.planner.keyframes.segment import Segment

SEGMENT = Segment(np.array([0.0, 2, 5, 9]), np.array([0.0, 10, 30, 20]), np.array([[0, 1.0], [0, 0], [0, 0], [2.0, 0]]))


def test_stretching_an_interval_moves_the_later_keys_and_no_duration_but_its_own() -> None:
    longer = SEGMENT.stretched(1, 4.0)
    assert longer.durations.tolist() == [2, 4, 4]
    assert longer.steps.tolist() == SEGMENT.steps.tolist()


def test_a_part_has_as_much_of_the_ramps_as_there_is_time_for() -> None:
    part = SEGMENT.part(0, 1)
    assert part.ramps is not None
    assert part.ramps.tolist() == [[0, 1], [1, 0]]
    assert part.times.tolist() == [0, 2]


def test_a_window_moves_at_its_ends_and_has_no_ramps() -> None:
    states = np.arange(8.0).reshape(4, 2)
    window = SEGMENT.window(1, 3, states)
    assert window.ends.tolist() == [[2, 3], [6, 7]]
    assert window.ramps is None


def test_it_is_cut_where_its_ramps_end() -> None:
    durations, intervals, ramps = SEGMENT.cuts(0.0)
    assert durations.tolist() == [1, 1, 3, 2, 2]
    assert intervals.tolist() == [0, 0, 1, 2, 2]
    assert ramps.tolist() == [1, 0, 0, 0, 2]


def test_a_ramp_that_ends_on_a_key_makes_no_cut() -> None:
    ramps = np.array([[0, 2.0 + 1e-9], [0, 0], [0, 0], [4.0, 0]])
    segment = Segment(SEGMENT.times, SEGMENT.positions, ramps)
    durations, _, found = segment.cuts(0.0)
    assert durations.tolist() == [2, 3, 4]
    assert found.tolist() == pytest.approx([2, 0, 4])


def test_no_two_cuts_are_nearer_than_the_solver_can_resolve() -> None:
    """2 s have no piece for what a ramp of 1.995 s leaves of them; nor has the solver one for a ramp of 5 ms."""
    long, short = np.zeros((4, 2)), np.zeros((4, 2))
    long[0, 1], short[0, 1] = 1.995, 0.005
    assert Segment(SEGMENT.times, SEGMENT.positions, long).cuts(0.0)[0].tolist() == [2, 3, 4]
    segment = Segment(SEGMENT.times, SEGMENT.positions, short)
    assert segment.cuts(0.0)[0].tolist() == pytest.approx([0.005, 1.995, 3, 4])
    assert segment.cuts(segment.resolved(jerk=600.0))[0].tolist() == [2, 3, 4]


def test_without_ramps_there_are_no_cuts() -> None:
    durations, _, ramps = Segment(SEGMENT.times, SEGMENT.positions).cuts(0.0)
    assert durations.tolist() == [2, 3, 4]
    assert np.isinf(ramps).all()


def test_it_is_cut_at_both_ends_of_a_turn() -> None:
    ramps = np.array([[0, 0], [0, 0], [1.0, 2.0], [0, 0]])
    durations, intervals, found = Segment(SEGMENT.times, SEGMENT.positions, ramps).cuts(0.0)
    assert durations.tolist() == [2, 2, 1, 2, 2]
    assert intervals.tolist() == [0, 1, 1, 2, 2]
    assert found.tolist() == [0, 0, 1, 2, 0]


def test_an_overshoot_is_nothing_where_it_has_to_be_directed_and_any_where_nothing_is_tolerated() -> None:
    segment = Segment(SEGMENT.times, SEGMENT.positions, stray=np.array([0.0, 1, 2]))
    assert segment.strays(directed=True).tolist() == [0, 0, 0]
    assert segment.strays(directed=False).tolist() == [0, 1, 2]
    assert segment.part(1, 3).strays(directed=False).tolist() == [1, 2]
    assert np.isinf(SEGMENT.strays(directed=False)).all()
