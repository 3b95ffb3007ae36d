"""Position commands and angle questions on the wire: words, signs, flags, aim, soft limits, wrap."""

import math

import pytest
from far_end import FarEnd
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits, Motion, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.gimbal.position import POLL_RATE, REFUSALS, REPEAT, TIME_FOR_ACTION, Angles, PositionSink
from teleop.dji.frame import Frame
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Result

LIMITS = {
    Axis.PAN: Limits(-math.inf, math.inf, 120, 240, 1200),
    Axis.TILT: Limits(-56, 146, 90, 180, 900),
    Axis.ROLL: Limits(-30, 30, 60, 120, 600),
}


def tick(time: float, motion: Motion) -> Tick:
    return Tick(time, motion, {}, (), {})


def sent(motion: Motion, signs: dict[Axis, int] | None = None, rate: int = 50, delay: float = 0.0) -> gimbal.Position:
    far = FarEnd()
    PositionSink(far.connection, rate, delay, Wiring(signs=signs or {}), LIMITS).write(tick(1.0, motion))
    [message] = far.serve(1.0)
    assert isinstance(message, gimbal.Position)
    return message


def test_each_axis_goes_into_its_own_field() -> None:
    command = sent({Axis.PAN: State(10.0), Axis.TILT: State(-20.0), Axis.ROLL: State(5.0)})
    assert (command.yaw, command.pitch, command.roll) == (10.0, -20.0, 5.0)
    assert command.absolute
    assert (command.yaw_ignored, command.roll_ignored, command.pitch_ignored) == (False, False, False)
    assert command.time_for_action == TIME_FOR_ACTION


def test_an_axis_that_is_not_in_use_is_ignored_by_the_gimbal() -> None:
    command = sent({Axis.TILT: State(-20.0)})
    assert (command.yaw_ignored, command.roll_ignored, command.pitch_ignored) == (True, True, False)


def test_signs_are_the_profiles() -> None:
    motion = {Axis.PAN: State(10.0), Axis.TILT: State(-20.0), Axis.ROLL: State(5.0)}
    command = sent(motion, {Axis.PAN: -1, Axis.ROLL: -1})
    assert (command.yaw, command.pitch, command.roll) == (-10.0, -20.0, -5.0)


def test_it_aims_ahead_by_the_time_for_action_at_the_speed_of_half_a_period_later() -> None:
    assert sent({Axis.PAN: State(10.0, 30.0, 0.0)}).yaw == pytest.approx(10 + 30 * TIME_FOR_ACTION, abs=0.05)
    assert sent({Axis.PAN: State(10.0, 30.0, 200.0)}).yaw == pytest.approx(10 + 32 * TIME_FOR_ACTION, abs=0.05)


def test_a_gimbal_that_is_known_to_be_late_is_told_earlier() -> None:
    assert sent({Axis.PAN: State(10.0, 30.0, 0.0)}, delay=0.1).yaw == pytest.approx(16.0, abs=0.05)


@given(st.floats(-56, 146), st.floats(-90, 90), st.floats(-180, 180))
def test_it_never_aims_beyond_a_soft_limit(position: float, velocity: float, acceleration: float) -> None:
    assert -56 <= sent({Axis.TILT: State(position, velocity, acceleration)}).pitch <= 146


@pytest.mark.parametrize(
    ("pan", "yaw"), [(180.0, 180.0), (-180.0, -180.0), (190.0, -170.0), (-200.0, 160.0), (720.5, 0.5)]
)
def test_a_continuous_axis_is_wrapped_on_the_wire(pan: float, yaw: float) -> None:
    assert sent({Axis.PAN: State(pan)}).yaw == yaw


def test_it_keeps_its_own_rate() -> None:
    far = FarEnd()
    sink = PositionSink(far.connection, 50, 0.0, Wiring(), LIMITS)
    for number in range(100):
        sink.write(tick(1 + number / 100, {Axis.PAN: State(number / 10)}))
    assert len(far.serve(2.0)) == 50
    sink.write(tick(10.0, {Axis.PAN: State(10.0)}))
    sink.write(tick(10.01, {Axis.PAN: State(10.1)}))
    assert len(far.serve(10.02)) == 1, "after a pause it must not catch up"


def test_what_rests_is_said_again_but_seldom() -> None:
    far = FarEnd()
    sink = PositionSink(far.connection, 50, 0.0, Wiring(), LIMITS)
    for number in range(500):
        sink.write(tick(1 + number / 100, {Axis.PAN: State(0.0)}))
    assert len(far.serve(6.0)) == pytest.approx(5 / REPEAT, abs=1)


def test_a_gimbal_that_goes_on_refusing_is_a_fault() -> None:
    far = FarEnd()
    far.replies[gimbal.Position] = lambda _command: Result(2)
    sink = PositionSink(far.connection, 50, 0.0, Wiring(), LIMITS)

    def move_for_a_second() -> None:
        for number in range(50):
            sink.write(tick(1 + number / 50, {Axis.PAN: State(number)}))
            far.serve(1 + number / 50)
            far.connection.poll(1.01 + number / 50)

    with pytest.raises(DeviceError, match=r"refuses to move \(return code 0x02\)"):
        move_for_a_second()
    assert len(far.heard) == REFUSALS


def angles_over(readings: list[tuple[float, float, float]], signs: dict[Axis, int]) -> list[dict[Axis, float]]:
    """What `Angles` reports after each of the gimbal's (yaw, roll, pitch)."""
    far = FarEnd()
    reporter = Angles(far.connection, Wiring(signs=signs))
    reported = []
    for number, (yaw, roll, pitch) in enumerate(readings):
        now = 1 + number / POLL_RATE
        far.replies[gimbal.Angles] = lambda _request, at=(yaw, roll, pitch): gimbal.AnglesReply(
            0, gimbal.AngleKind.ATTITUDE, *at
        )
        reporter.report(now)
        far.serve(now)
        reported.append({axis: reading.position for axis, reading in reporter.report(now + 0.01).items()})
    return reported


def test_angles_come_back_in_the_operators_words_and_signs() -> None:
    assert angles_over([(1.0, 2.0, 3.0)], {Axis.ROLL: -1}) == [{Axis.PAN: 1.0, Axis.ROLL: -2.0, Axis.TILT: 3.0}]


def test_an_angle_that_wraps_goes_on() -> None:
    pans = [each[Axis.PAN] for each in angles_over([(yaw, 0.0, 0.0) for yaw in (170.0, 179.9, -179.9, -90.0, 0.0)], {})]
    assert pans == pytest.approx([170, 179.9, 180.1, 270, 360])


def push(yaw: float, roll: float, pitch: float, valid: bool = True) -> gimbal.Push:
    return gimbal.Push(valid, False, False, yaw, roll, pitch, 0.0, 0.0, 0.0, 145, 55, 179, 179, 30, 30, 50, 50, 50)


def test_a_gimbal_that_does_not_answer_is_asked_to_push_and_read_from_that() -> None:
    far = FarEnd()
    reporter = Angles(far.connection, Wiring(signs={Axis.TILT: -1}))
    for number in range(30):
        reporter.report(number / 100)
        far.serve(number / 100)
    assert gimbal.PushSettings(gimbal.Switch.ON) in far.heard
    far.push(push(99.0, 99.0, 99.0, valid=False))
    far.push(push(10.0, 2.0, -5.0))
    readings = reporter.report(0.31)
    assert readings == {axis: Reading(p, 0.31) for axis, p in ((Axis.PAN, 10.0), (Axis.ROLL, 2.0), (Axis.TILT, 5.0))}


def test_a_gimbal_that_answers_is_not_asked_to_push_nor_believed_when_it_does() -> None:
    far = FarEnd()
    far.replies[gimbal.Angles] = lambda _request: gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 1.0, 0.0, 0.0)
    reporter = Angles(far.connection, Wiring())
    for number in range(30):
        far.push(push(10.0, 0.0, 0.0))
        readings = reporter.report(1 + number / 100)
        far.serve(1 + number / 100)
        assert number < 2 or readings[Axis.PAN].position == 1.0
    assert not any(isinstance(message, gimbal.PushSettings) for message in far.heard)


def test_angles_that_are_not_ready_are_no_reading() -> None:
    far = FarEnd()
    far.replies[gimbal.Angles] = lambda _request: gimbal.AnglesReply(0, gimbal.AngleKind.NONE, 0.0, 0.0, 0.0)
    reporter = Angles(far.connection, Wiring())
    reporter.report(1.0)
    far.serve(1.0)
    assert reporter.report(1.01) == {}


@pytest.mark.parametrize("value", ["00 01 0a00 1400 1e00", "00 0a00 1400 1e00"], ids=["with type", "without"])
@pytest.mark.parametrize(("order", "roll", "tilt"), [("yaw-roll-pitch", 2.0, 3.0), ("yaw-pitch-roll", 3.0, 2.0)])
def test_replies_of_old_firmware_are_read_in_the_order_of_the_profile(
    order: str, roll: float, tilt: float, value: str
) -> None:
    far = FarEnd()
    reporter = Angles(far.connection, Wiring(), order)
    reporter.report(1.0)
    far.link.send(Frame(bytes.fromhex(value), 0x20, 0).encode())
    readings = reporter.report(1.01)
    assert {axis: reading.position for axis, reading in readings.items()} == {
        Axis.PAN: 1.0,
        Axis.ROLL: roll,
        Axis.TILT: tilt,
    }


def test_the_order_of_old_firmware_is_not_that_of_replies_with_set_and_id() -> None:
    far = FarEnd()
    far.replies[gimbal.Angles] = lambda _request: gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 1.0, 2.0, 3.0)
    reporter = Angles(far.connection, Wiring(), "yaw-pitch-roll")
    reporter.report(1.0)
    far.serve(1.0)
    assert reporter.report(1.01)[Axis.ROLL].position == 2.0


def test_a_push_of_25_bytes_with_the_reply_bit_is_read() -> None:
    far = FarEnd()
    reporter = Angles(far.connection, Wiring())
    for number in range(30):
        reporter.report(number / 100)
        far.serve(number / 100)
    pushed = Frame(bytes.fromhex("0e08 01 6400 1400 ceff"), 0x20, 3).encode()
    assert len(pushed) == 25
    far.link.send(pushed)
    readings = reporter.report(0.31)
    assert {axis: reading.position for axis, reading in readings.items()} == {
        Axis.PAN: 10.0,
        Axis.ROLL: 2.0,
        Axis.TILT: -5.0,
    }
