"""A track with an offset added, and what it reaches between times."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from teleop.planner.offset_track import added, spans
from teleop.planner.trajectory import Track

BASE = Track.through(np.array([0.0, 1.0, 3.3]), np.array([[0.0, 10, -5], [0, 5, 0], [0, 2, 0]]))
OFFSET = Track.through(np.array([-0.3, 1.0, 2.0, 3.6]), np.array([[0.0, 1, -1, 0], [0, 0, 3, 0], [0, 1, 0, 0]]))


def test_the_sum_is_the_sum_at_every_time_before_and_after_too():
    times = np.linspace(-1, 5, 601)
    assert added(BASE, OFFSET).sample(times)[:3] == pytest.approx(
        BASE.sample(times)[:3] + OFFSET.sample(times)[:3], abs=1e-9
    )


def test_a_break_of_both_is_one_break():
    assert added(BASE, OFFSET).breaks == pytest.approx([-0.3, 0, 1, 2, 3.3, 3.6])


def test_the_spans_hold_everything_between_their_edges():
    edges = np.array([-0.2, 0.5, 1.4, 4.0])
    least, greatest = spans(BASE, edges)
    for number, (low, high) in enumerate(pairwise(edges.tolist())):
        rows = BASE.sample(np.linspace(low, high, 200)[:-1])
        assert (rows.min(axis=1) >= least[:, number] - 1e-6).all()
        assert (rows.max(axis=1) <= greatest[:, number] + 1e-6).all()
    assert greatest[0].max() == pytest.approx(BASE.peaks().maximum)
