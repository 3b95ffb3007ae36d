"""Few points, and nothing of the move lost between them."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from random_tracks import random_track

from teleop.planner.polynomial import extremes
from teleop.planner.trajectory import Track
from teleop.plots.downsample import COARSEST, MOST, QUANTITIES, curve

TRACKS = st.builds(
    random_track,
    st.one_of(st.integers(0, 40), st.integers(400, 5000)),
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 2.5]),
)


def between_points(track: Track) -> list[float]:
    """The most by which each quantity can pass its neighbouring points: h2 / 8 of its second derivative."""
    if len(track.coefficients) == 0:
        return [0.0] * 4
    widths = np.diff(track.breaks)
    c = track.coefficients.T
    snap = np.abs([24 * c[4], 24 * c[4] + 120 * c[5] * widths]).max(axis=0)
    least, greatest = extremes(track.coefficients, widths)
    _, _, acceleration, jerk = np.maximum(-least, greatest)
    seconds = [acceleration, jerk, snap, np.abs(120 * c[5])]
    return [float((second * (widths / (COARSEST - 1)) ** 2 / 8).max()) for second in seconds]


@settings(max_examples=20, deadline=None)
@given(TRACKS, st.sampled_from([0.0, 30.0]))
def test_points_are_few_in_order_and_on_the_track(track: Track, rest: float) -> None:
    duration = float(track.breaks[-1]) + rest
    times, rows = curve(track, duration)
    assert len(times) <= MOST
    assert rows.shape == (len(QUANTITIES), len(times))
    assert (times[0], times[-1]) == (0, duration)
    assert (np.diff(times) >= 0).all()
    np.testing.assert_array_equal(rows, track.sample(times))


@settings(max_examples=10, deadline=None)
@given(TRACKS)
def test_no_peak_goes_missing(track: Track) -> None:
    _, rows = curve(track, float(track.breaks[-1]))
    peaks = track.peaks()
    missed = [
        max(peaks.maximum - rows[0].max(), rows[0].min() - peaks.minimum),
        peaks.velocity - np.abs(rows[1]).max(),
        peaks.acceleration - np.abs(rows[2]).max(),
        peaks.jerk - np.abs(rows[3]).max(),
    ]
    for name, size, bound, row in zip(QUANTITIES, missed, between_points(track), rows, strict=True):
        assert size <= bound + 1e-9 * (1 + np.abs(row).max()), name


def test_a_second_in_the_middle_of_a_day_is_as_fine_as_a_second() -> None:
    smooth = np.array([0, 0, 0, 10, -15, 6])
    short = Track(np.array([0.0, 1.0]), smooth[None] * 1.0, 1.0)
    rest = np.array([[0.0] * 6, smooth, [1.0] + [0.0] * 5])
    long = Track(np.array([0.0, 43200.0, 43201.0, 86400.0]), rest, 1.0)
    inside = [
        np.count_nonzero((times >= at) & (times < at + 1))
        for at, times in ((0, curve(short, 1).times), (43200, curve(long, 86400).times))
    ]
    assert inside[0] == inside[1] > 100
    assert len(curve(long, 86400).times) < inside[1] + 8  # each rest brings its ends and nothing between them


def test_a_step_of_jerk_is_a_step() -> None:
    coefficients = np.array([[0, 0, 0, 1, 0, 0], [1, 3, 3, -1, 0, 0]], dtype=float)
    times, rows = curve(Track(np.array([0.0, 1.0, 2.0]), coefficients, 6.0), 2)
    step = int(np.searchsorted(times, 1.0))
    assert times[step] - times[step - 1] < 1e-9
    assert (rows[3, step - 1], rows[3, step]) == (6, -6)
