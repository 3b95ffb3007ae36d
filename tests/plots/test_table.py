"""The table: columns, exact times, values that are the move's, made a piece at a time."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_tracks import random_track

from teleop.core.axes import Axis
from teleop.planner.trajectory import CHUNK, Move, Track
from teleop.plots.table import header, lines


def test_the_header_names_every_column() -> None:
    assert header([Axis.PAN, Axis.STICK_ROLL]) == (
        "time,pan,pan_velocity,pan_acceleration,pan_jerk,"
        "stick_roll,stick_roll_velocity,stick_roll_acceleration,stick_roll_jerk\n"
    )


@settings(max_examples=30, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.integers(1, 4), st.one_of(st.sampled_from([100.0, 24.0, 30.0]), st.floats(0.1, 50))
)
def test_rows_are_at_whole_periods_up_to_the_end(seed: int, pieces: int, rate: float) -> None:
    track = random_track(pieces, seed)
    whole = Move({Axis.TILT: track})
    rows = [
        [float(cell) for cell in line.split(",")] for text in lines(whole.chunks(rate)) for line in text.splitlines()
    ]
    assert [row[0] for row in rows] == [k / rate for k in range(len(rows))]
    assert rows[-1][0] <= whole.duration * (1 + 1e-9) < len(rows) / rate + 1e-9
    for time, *values in rows[:: max(1, len(rows) // 20)]:
        state = track.at(time)
        assert values[:3] == [pytest.approx(value, rel=1e-9, abs=1e-12) for value in state]


def test_the_end_is_in_it() -> None:
    whole = Move({Axis.PAN: Track.constant(15.0, 3.0)})
    (text,) = lines(whole.chunks(100))
    assert len(text.splitlines()) == 1501
    assert text.splitlines()[-1] == "15.0,3,0,0,0"


def test_a_day_is_made_a_piece_at_a_time() -> None:
    day = Move({Axis.PAN: Track.constant(86400.0, 3.0)})
    assert len(next(lines(day.chunks(1000))).splitlines()) == CHUNK
