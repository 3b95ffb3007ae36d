"""Runs through exposures: where they are when, within the limits, from rest to rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.core.axes import Limits, State
from teleop.planner.go_motion import RAMP, ExposureRuns

LIMITS = Limits(-180, 180, 120, 240, 1200)
places = st.lists(st.floats(-100, 100), min_size=1, max_size=4).map(np.array)


@settings(max_examples=60, deadline=None)
@given(places, st.floats(0, 1), st.floats(0.01, 20))
def test_a_run_is_at_its_places_at_the_start_the_middle_and_the_end(places, blur: float, exposure: float) -> None:
    runs = ExposureRuns.along(places, blur, exposure, LIMITS)
    for frame, place in enumerate(places):
        before, after = places[max(0, frame - 1)], places[min(frame + 1, len(places) - 1)]
        track = runs.track(frame)
        assert track.at(0).position == pytest.approx(place - (place - before) * blur, abs=1e-9)
        assert track.at(exposure / 2).position == pytest.approx(place, abs=1e-9)
        assert track.at(exposure).position == pytest.approx(place + (after - place) * blur, abs=1e-9)
        assert track.breaks[0] == -RAMP
        assert track.breaks[-1] == exposure + RAMP
        assert tuple(track.at(-RAMP)) == pytest.approx((runs.starts[frame], 0.0, 0.0))
        assert track.at(exposure + RAMP) == State(runs.ends[frame])


@settings(max_examples=60, deadline=None)
@given(places, st.floats(0, 1), st.floats(0.05, 20))
def test_a_run_that_is_within_its_limits_by_its_shares_is_so_at_every_instant(places, blur, exposure) -> None:
    runs = ExposureRuns.along(places, blur, exposure, LIMITS)
    shares = runs.shares()
    for frame in range(len(places)):
        track = runs.track(frame)
        times = np.linspace(-RAMP, exposure + RAMP, 2001)
        position, velocity, acceleration, jerk = np.abs(track.sample(times))
        for name, values, limit in (
            ("velocity", velocity, LIMITS.velocity),
            ("acceleration", acceleration, LIMITS.acceleration),
            ("jerk", jerk, LIMITS.jerk),
        ):
            share = shares[name][frame]
            assert values.max() <= share * limit * 0.97 * (1 + 1e-6) + 1e-6, name
        assert shares["soft"][frame] > 0 or position.max() <= LIMITS.maximum + 1e-6


@settings(max_examples=60, deadline=None)
@given(places, st.floats(0, 1), st.floats(0.05, 20))
def test_a_run_is_smooth_where_its_pieces_meet(places, blur: float, exposure: float) -> None:
    runs = ExposureRuns.along(places, blur, exposure, LIMITS)
    for frame in range(len(places)):
        track = runs.track(frame)
        scale = 1 + max(float(np.abs(row).max()) for row in track.sample(track.breaks[:-1])[:3])
        for time in track.breaks.tolist():
            left, right = np.array(track.at(np.nextafter(time, -np.inf))), np.array(track.at(time))
            assert right == pytest.approx(left, abs=1e-7 * scale)


def test_the_speed_is_even_on_both_sides_where_the_frames_are() -> None:
    track = ExposureRuns.along(np.array([0.0, 2.0, 4.0]), 0.5, 1.0, LIMITS).track(1)
    assert track.sample(np.linspace(0, 1, 101))[1] == pytest.approx(2.0)


def test_the_first_frame_rests_before_its_middle_and_the_last_one_after_it() -> None:
    runs = ExposureRuns.along(np.array([0.0, 2.0, 4.0]), 0.5, 1.0, LIMITS)
    first, last = runs.track(0), runs.track(2)
    times = np.linspace(-1, 0.5, 50)
    assert not first.sample(times)[1].any()
    assert not last.sample(1 - times)[1].any()
    assert first.next_motion(-1) == 0.5


def test_a_run_does_not_pass_the_place_where_the_move_turns() -> None:
    track = ExposureRuns.along(np.array([0.0, 3.0, 1.0]), 1.0, 1.0, LIMITS).track(1)
    assert track.peaks().maximum == pytest.approx(3.0)


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 50), st.floats(0, 50), st.floats(0.1, 1))
def test_a_run_through_a_frame_on_a_way_that_does_not_turn_does_not_turn(first, last, blur) -> None:
    track = ExposureRuns.along(np.array([0, first, first + last]), blur, 1.0, LIMITS).track(1)
    assert track.sample(np.linspace(-1, 2, 601))[1].min() >= -1e-9 * (1 + first + last)


def test_frames_that_are_still_do_not_move() -> None:
    track = ExposureRuns.along(np.array([5.0, 5.0, 5.0]), 1.0, 0.5, LIMITS).track(1)
    assert track.next_motion(-2) == np.inf
