"""The focus motor on the wire: steps, when they are sent, and a motor that is not calibrated."""

import pytest
from far_end import FarEnd
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.focus import REPEAT, FocusReporter, FocusSink
from teleop.dji.gimbal import focus


def tick(time: float, position: float) -> Tick:
    return Tick(time, {Axis.FOCUS: State(position)}, {}, (), {})


@given(st.floats(0, 1))
def test_near_to_far_is_the_motors_range_without_its_zero(position: float) -> None:
    far = FarEnd()
    FocusSink(far.connection, 50).write(tick(1.0, position))
    [message] = far.serve(1.0)
    assert isinstance(message, focus.Set)
    assert 1 <= message.position <= 4095
    assert message.position == max(1, round(position * 4095))


def test_it_sends_changes_at_its_rate_and_repeats_what_stays() -> None:
    far = FarEnd()
    sink = FocusSink(far.connection, 50)
    for number in range(100):
        sink.write(tick(1 + number / 100, number / 100))
    assert len(far.serve(2.0)) == 50
    for number in range(200):
        sink.write(tick(2 + number / 100, 0.98))
    assert len(far.serve(4.0)) == pytest.approx(2.0 / REPEAT, abs=1)


def test_a_rig_without_the_axis_in_use_leaves_the_motor_alone() -> None:
    far = FarEnd()
    FocusSink(far.connection, 50).write(Tick(1.0, {Axis.PAN: State(0.0)}, {}, (), {}))
    assert far.serve(1.0) == []


@pytest.mark.parametrize("state", list(focus.EndpointState))
def test_the_reporter_reads_steps_and_refuses_an_uncalibrated_motor(state: focus.EndpointState) -> None:
    far = FarEnd()
    far.replies[focus.Get] = lambda _request: focus.GetReply(0, 0, state, 2048)
    reporter = FocusReporter(far.connection)
    assert reporter.report(1.0) == {}
    far.serve(1.0)
    if state is focus.EndpointState.UNCALIBRATED:
        with pytest.raises(DeviceError, match="not calibrated"):
            reporter.report(1.01)
    else:
        assert reporter.report(1.01) == {Axis.FOCUS: Reading(2048 / 4095, 1.0)}
