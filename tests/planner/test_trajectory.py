"""A move evaluated one instant at a time, in arrays and in chunks is the same move."""

import math

import numpy as np
import pytest

from teleop.core.axes import Axis, State
from teleop.planner.trajectory import CHUNK, Move, Track

PAN, TILT = Axis.PAN, Axis.TILT


@pytest.fixture
def track():
    """Two pieces, from rest at 1 to rest at 3, between 2 s and 5 s."""
    rise = [10.0, -15.0, 6.0]
    first = [1.0, 0.0, 0.0, *(x / 2 ** (k + 3) for k, x in enumerate(rise))]
    second = [2.0, 0.0, 0.0, *rise]
    return Track(np.array([2.0, 4.0, 5.0]), np.array([first, second]), 3.0)


def test_it_rests_before_and_after(track):
    assert track.at(-1.0) == track.at(0.0) == State(1.0, 0.0, 0.0)
    assert track.at(5.0) == track.at(1e9) == State(3.0, 0.0, 0.0)


def test_one_instant_and_arrays_agree(track):
    times = np.array([7.0, 0.0, 2.0, 2.7, 4.0, 4.31, 5.0, 3.999])
    rows = track.sample(times)
    for i, time in enumerate(times):
        assert tuple(rows[:3, i]) == pytest.approx(track.at(time), abs=1e-12)


def test_jerk_is_the_derivative_of_acceleration(track):
    step = 1e-5
    times = np.array([2.5, 3.1, 4.4])
    slope = (track.sample(times + step)[2] - track.sample(times - step)[2]) / (2 * step)
    assert track.sample(times)[3] == pytest.approx(slope, rel=1e-5)


def test_peaks_are_those_of_the_minimum_jerk_quintic(track):
    peaks = track.peaks()
    assert peaks.velocity == pytest.approx(15 / 8)
    assert peaks.acceleration == pytest.approx(10 / math.sqrt(3))
    assert peaks.jerk == pytest.approx(60)
    assert (peaks.minimum, peaks.maximum) == pytest.approx((1, 3))


def test_a_constant_track():
    still = Track.constant(3.0, 0.5)
    assert still.at(0.0) == still.at(4.0) == State(0.5)
    assert still.sample(np.array([0.0, 9.0])).tolist() == [[0.5, 0.5], [0, 0], [0, 0], [0, 0]]
    peaks = still.peaks()
    assert (peaks.velocity, peaks.minimum, peaks.maximum) == (0.0, 0.5, 0.5)


def test_a_move_lasts_as_long_as_its_last_axis(track):
    move = Move({PAN: track, TILT: Track.constant(1.0, 0.5)})
    assert move.duration == 5.0
    assert move.start == {PAN: State(1.0), TILT: State(0.5)}
    assert move.end == {PAN: State(3.0), TILT: State(0.5)}
    assert move.at(2.7)[PAN] == track.at(2.7)


def test_chunks_cover_the_move_once_and_end_on_its_end(track):
    rate = 4 * CHUNK / 5.0
    move = Move({PAN: track})
    sizes, times, positions = [], [], []
    for at, samples in move.chunks(rate):
        sizes.append(len(at))
        times.append(at)
        positions.append(samples[PAN][0])
    assert max(sizes) == CHUNK
    times, positions = np.concatenate(times), np.concatenate(positions)
    np.testing.assert_allclose(times, np.arange(4 * CHUNK + 1) / rate)
    assert positions[-1] == 3.0
