"""Cuts add up to the segments and never leave neighbours too unequal."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from teleop.planner.keyframes.mesh import GRADE, mesh

durations = st.lists(st.floats(-2, 5).map(lambda x: 10.0**x), min_size=1, max_size=6).map(np.array)


@given(durations, st.sampled_from([2, 4, 8]))
def test_pieces_add_up_to_their_segments(seconds, pieces):
    segment, widths, keys = mesh(seconds, pieces)
    np.testing.assert_allclose(np.bincount(segment, widths), seconds, rtol=1e-12)
    assert (np.bincount(segment) >= pieces).all()
    np.testing.assert_allclose(
        np.concatenate([[0], np.cumsum(widths)])[keys], np.concatenate([[0], np.cumsum(seconds)])
    )


@given(durations, st.sampled_from([2, 4, 8]))
def test_the_first_piece_beside_a_shorter_segment_is_like_its_neighbours(seconds, pieces):
    _, widths, keys = mesh(seconds, pieces)
    for key in keys[1:-1]:
        left, right = widths[key - 1], widths[key]
        assert max(left, right) <= 2 * GRADE * min(left, right) * (1 + 1e-9)


def test_even_segments_are_cut_evenly():
    _, widths, keys = mesh(np.array([1.0, 2.0]), 2)
    assert widths.tolist() == [0.5, 0.5, 1.0, 1.0]
    assert keys.tolist() == [0, 2, 4]
