"""The way to a place: together, gently, exactly there."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.planner.rest_to_rest import rest_to_rest

PAN, FOCUS = Axis.PAN, Axis.FOCUS
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), FOCUS: Limits(0, 1, 0.8, 3, 20)}
places = st.fixed_dictionaries({PAN: st.floats(-170, 170), FOCUS: st.floats(0, 1)})


@given(places, places, st.sampled_from([0.25, 0.5, 1.0]))
def test_it_stays_within_its_share_and_one_axis_uses_all_of_it(start, target, share):
    assume(abs(start[PAN] - target[PAN]) > 1e-3)
    move = rest_to_rest({axis: State(p) for axis, p in start.items()}, target, LIMITS, share)
    used = []
    for axis, peaks in move.peaks().items():
        limits = LIMITS[axis]
        used += [
            peaks.velocity / limits.velocity,
            peaks.acceleration / limits.acceleration,
            peaks.jerk / limits.jerk,
        ]
    assert max(used) == pytest.approx(share, rel=1e-6)


@given(places, places)
def test_all_axes_start_where_they_are_and_end_exactly_there_without_passing(start, target):
    move = rest_to_rest({axis: State(p) for axis, p in start.items()}, target, LIMITS)
    assert {axis: state.position for axis, state in move.end.items()} == target
    for axis, state in move.start.items():
        assert state.position == pytest.approx(start[axis], abs=1e-12)
        peaks = move.peaks()[axis]
        assert peaks.minimum >= min(start[axis], target[axis]) - 1e-9
        assert peaks.maximum <= max(start[axis], target[axis]) + 1e-9


def test_already_there_takes_no_time():
    move = rest_to_rest({PAN: State(10.0)}, {PAN: 10.0}, LIMITS)
    assert move.duration == 0.0
    assert move.end == {PAN: State(10.0)}


def test_an_axis_that_stays_does_not_move_while_another_does():
    move = rest_to_rest({PAN: State(0.0), FOCUS: State(0.3)}, {PAN: 30.0, FOCUS: 0.3}, LIMITS)
    assert move.at(move.duration / 2)[FOCUS] == State(0.3)
    assert move.at(move.duration / 2)[PAN].position == pytest.approx(15)
