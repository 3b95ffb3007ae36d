"""The simulated gimbal as seen over the wire: motion. What it answers besides is in test_answers.py."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sim_bench import Bench

from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message, Result, ReturnCode
from teleop.sim.gimbal.device import SimulatedGimbal

OK = Result(ReturnCode.OK)
FAILED = Result(ReturnCode.FAILED)


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_the_published_sample_frame_turns_each_axis_by_its_own_angle() -> None:
    """R SDK V2.5, section 3.3: yaw 3.2, roll 4.8, pitch 6.4 degrees within 2 s."""
    sample = bytes.fromhex("aa1a0003000000002211a2420e0020003000400001147b4097be")
    device = SimulatedGimbal()
    device.receive(sample, 0.0)
    device.advance(1.0)
    assert device.angles == pytest.approx((1.6, 2.4, 3.2))
    device.advance(2.0)
    assert device.angles == (3.2, 4.8, 6.4)


def test_a_position_is_reached_at_constant_speed_in_its_time(bench: Bench) -> None:
    assert bench.ask(gimbal.Position(90.0, 10.0, -20.0, time_for_action=5.0)) == OK
    bench.wait(2.0)
    assert bench.gimbal.angles == pytest.approx((36.0, 4.0, -8.0))
    assert bench.gimbal.rates == pytest.approx((18.0, 2.0, -4.0))
    bench.wait(3.0)
    assert bench.gimbal.angles == (90.0, 10.0, -20.0)
    assert bench.gimbal.rates == (0.0, 0.0, 0.0)


def test_a_new_position_replaces_the_old_one_from_where_it_is(bench: Bench) -> None:
    bench.tell(gimbal.Position(90.0, 0.0, 0.0, time_for_action=10.0))
    bench.now = 5.0
    bench.tell(gimbal.Position(0.0, 0.0, 0.0, time_for_action=5.0))
    bench.now = 7.5
    bench.listen()
    assert bench.gimbal.angles.yaw == pytest.approx(22.5)


def test_an_ignored_axis_keeps_doing_what_it_does(bench: Bench) -> None:
    bench.tell(gimbal.Position(100.0, 0.0, 0.0, time_for_action=10.0))
    bench.now = 5.0
    bench.tell(gimbal.Position(0.0, 20.0, 40.0, yaw_ignored=True, roll_ignored=True, time_for_action=5.0))
    bench.now = 10.0
    bench.listen()
    assert bench.gimbal.angles == pytest.approx((100.0, 0.0, 40.0))


def test_an_incremental_position_counts_from_where_it_is(bench: Bench) -> None:
    for _ in range(2):
        bench.tell(gimbal.Position(10.0, -1.0, 5.0, absolute=False, time_for_action=1.0))
        bench.now += 1.0
        bench.listen()
    assert bench.gimbal.angles == pytest.approx((20.0, -2.0, 10.0))


def test_a_time_that_wrapped_to_nothing_is_refused(bench: Bench) -> None:
    assert bench.ask_raw(bytes.fromhex("0e00c2010000000001") + b"\x00") == [b"\x0e\x00\x01"]
    bench.wait(1.0)
    assert bench.gimbal.angles == (0.0, 0.0, 0.0)


def test_targets_beyond_the_stops_end_at_the_stops(bench: Bench) -> None:
    bench.tell(gimbal.Position(170.0, 30.0, 140.0, absolute=False, time_for_action=1.0))
    bench.now = 1.0
    bench.tell(gimbal.Position(170.0, 30.0, 140.0, absolute=False, time_for_action=1.0))
    bench.now = 2.0
    bench.listen()
    assert bench.gimbal.angles == (180.0, 30.0, 146.0)


def test_a_speed_is_reached_through_the_lag_and_holds_for_half_a_second(bench: Bench) -> None:
    bench.tell(gimbal.Speed(20.0, -4.0, 8.0))
    bench.now = 0.05
    bench.listen()
    assert bench.gimbal.rates == pytest.approx([value * (1 - 1 / math.e) for value in (20.0, -4.0, 8.0)])
    bench.now = 0.5
    bench.listen()
    assert bench.gimbal.rates == pytest.approx((20.0, -4.0, 8.0), rel=1e-4)
    bench.now = 0.55
    bench.listen()
    assert bench.gimbal.rates == pytest.approx([value / math.e for value in (20.0, -4.0, 8.0)], rel=1e-4)
    bench.now = 4.0
    bench.listen()
    assert bench.gimbal.angles == pytest.approx((10.0, -2.0, 4.0))
    assert bench.gimbal.controlled


def test_releasing_speed_control_stops(bench: Bench) -> None:
    bench.tell(gimbal.Speed(20.0, 0.0, 0.0))
    bench.now = 0.4
    bench.tell(gimbal.Speed(20.0, 0.0, 0.0, take_over=False))
    assert not bench.gimbal.controlled
    bench.now = 3.0
    bench.listen()
    assert bench.gimbal.angles.yaw == pytest.approx(20.0 * 0.4)
    bench.tell(gimbal.Speed(20.0, 0.0, 0.0, take_over=False))
    bench.now = 4.0
    bench.listen()
    assert bench.gimbal.angles.yaw == pytest.approx(20.0 * 0.4)


def test_the_bits_that_programs_in_the_field_set_are_no_mistake(bench: Bench) -> None:
    assert bench.ask_raw(bytes.fromhex("0e01640000000000") + b"\x8c") == [b"\x0e\x01\x00"]
    bench.wait(0.4)
    assert bench.gimbal.angles.yaw > 3.0


def test_a_joystick_moves_each_axis_at_its_own_speed() -> None:
    bench = Bench(joystick_speed=(60.0, 30.0, 40.0))
    bench.tell(gimbal.Joystick(pitch=15000, roll=-7500, yaw=3000))
    bench.now = 0.5
    assert not bench.listen()
    assert bench.gimbal.rates == pytest.approx((12.0, -15.0, 40.0), rel=1e-4)
    bench.wait(3.0)
    assert bench.gimbal.rates == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert not bench.gimbal.controlled


def test_a_deflection_beyond_full_is_full(bench: Bench) -> None:
    bench.ask_raw(bytes.fromhex("0e0a01ff7f00000080"), cmd_type=0)
    bench.wait(0.5)
    assert bench.gimbal.rates == pytest.approx((-60.0, 0.0, 60.0), rel=1e-4)


def test_a_gimbal_that_turns_for_ever_goes_the_short_way_and_reports_half_turns() -> None:
    bench = Bench(continuous=True, boot=(170.0, 0.0, 0.0))
    bench.tell(gimbal.Position(-170.0, 0.0, 0.0, time_for_action=1.0))
    bench.now = 1.0
    bench.listen()
    assert bench.gimbal.angles.yaw == 190.0
    reply = bench.ask(gimbal.Angles())
    assert isinstance(reply, gimbal.AnglesReply)
    assert reply.yaw == -170.0
    for _ in range(100):
        bench.tell(gimbal.Speed(360.0, 0.0, 0.0))
        bench.now += 0.5
    bench.listen()
    assert bench.gimbal.angles.yaw > 17_000.0


def test_signs_of_the_firmware_hold_for_commands_and_reports() -> None:
    bench = Bench(signs=(-1, 1, -1), boot=(10.0, 5.0, -7.0))
    assert bench.ask(gimbal.Angles()) == gimbal.AnglesReply(ReturnCode.OK, gimbal.AngleKind.ATTITUDE, -10.0, 5.0, 7.0)
    bench.tell(gimbal.Position(30.0, 3.0, 20.0, time_for_action=1.0))
    bench.now = 1.0
    bench.listen()
    assert bench.gimbal.angles == (-30.0, 3.0, -20.0)
    bench.tell(gimbal.Joystick(pitch=100, roll=100, yaw=100))
    bench.now = 1.4
    bench.listen()
    assert [math.copysign(1.0, rate) for rate in bench.gimbal.rates] == [-1.0, 1.0, -1.0]


def test_angles_are_reported_on_the_grid_of_a_tenth_of_a_degree() -> None:
    bench = Bench(boot=(12.34, -5.678, 90.06))
    assert bench.ask(gimbal.Angles(gimbal.AngleKind.JOINT)) == gimbal.AnglesReply(
        ReturnCode.OK, gimbal.AngleKind.JOINT, 12.3, -5.7, 90.1
    )
    assert bench.gimbal.angles == (12.34, -5.678, 90.06)


def test_recentring_eases_to_the_centre_and_selfie_turns_round(bench: Bench) -> None:
    bench.tell(gimbal.Position(90.0, 10.0, 40.0, time_for_action=1.0))
    bench.now = 1.0
    bench.tell(gimbal.Mode(action=gimbal.CenterAction.RECENTER))
    yaws = []
    for bench.now in (1.0, 1.5, 2.0, 2.5, 3.0):
        bench.listen()
        yaws.append(bench.gimbal.angles.yaw)
    assert yaws == sorted(yaws, reverse=True)
    assert bench.gimbal.angles == pytest.approx((0.0, 0.0, 0.0), abs=0.2)
    bench.tell(gimbal.Mode(action=gimbal.CenterAction.SELFIE))
    bench.now = 60.0
    bench.listen()
    assert bench.gimbal.angles == (180.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "message",
    [
        gimbal.Position(90.0, 0.0, 0.0),
        gimbal.Speed(30.0, 0.0, 0.0),
        gimbal.Mode(action=gimbal.CenterAction.SELFIE),
        gimbal.Mode(mode=gimbal.FollowMode.LOCK),
    ],
)
def test_asleep_it_stops_and_refuses_to_move(bench: Bench, message: Message) -> None:
    bench.tell(gimbal.Speed(30.0, 0.0, 0.0))
    bench.now = 0.3
    sleep = (gimbal.Parameter(gimbal.ParameterId.MOTOR, b"\x01"),)
    assert bench.ask(gimbal.SetParameters(sleep)) == gimbal.SetParametersReply(ReturnCode.OK, sleep)
    here = bench.gimbal.angles
    assert bench.ask(message) == FAILED
    bench.tell(gimbal.Joystick(15000, 15000, 15000))
    bench.wait(1.0)
    assert bench.gimbal.angles == here
    bench.ask(gimbal.SetParameters((gimbal.Parameter(gimbal.ParameterId.MOTOR, b"\x00"),)))
    assert bench.ask(message) == OK


def test_narrower_limits_stop_it_earlier(bench: Bench) -> None:
    assert bench.ask(gimbal.SetLimits(20, 10, 50, 40, 5, 6)) == OK
    assert bench.ask(gimbal.Limits()) == gimbal.LimitsReply(ReturnCode.OK, 20, 10, 50, 40, 5, 6)
    for sign, reached in ((1.0, (50.0, 5.0, 20.0)), (-1.0, (-40.0, -6.0, -10.0))):
        bench.tell(gimbal.Position(90.0 * sign, 30.0 * sign, 50.0 * sign, time_for_action=1.0))
        bench.now += 1.0
        bench.listen()
        assert bench.gimbal.angles == reached


def test_six_hours_of_rest_cost_no_more_than_a_second_of_them(bench: Bench) -> None:
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.tell(gimbal.Position(12.3, 4.5, 6.7, time_for_action=2.0))
    bench.now = 6 * 3600.0
    bench.listen()
    assert bench.gimbal.angles == (12.3, 4.5, 6.7)
    assert len(bench.unasked) == 11  # the answer to the position, and the pushes of the last second


moves = st.one_of(
    st.builds(
        gimbal.Position,
        *(st.integers(-most, most).map(lambda tenths: tenths / 10) for most in (1800, 300, 560)),
        absolute=st.booleans(),
        yaw_ignored=st.booleans(),
        time_for_action=st.integers(1, 255).map(lambda tenths: tenths / 10),
    ),
    st.builds(gimbal.Speed, *(st.floats(-360, 360) for _ in range(3)), take_over=st.booleans()),
    st.builds(gimbal.Joystick, *(st.integers(-15000, 15000) for _ in range(3))),
    st.builds(gimbal.Mode, action=st.sampled_from([gimbal.CenterAction.RECENTER, gimbal.CenterAction.SELFIE])),
    st.builds(gimbal.Calibrate, st.booleans()),
    st.builds(gimbal.PushSettings, st.sampled_from([gimbal.Switch.ON, gimbal.Switch.OFF])),
    st.builds(focus.Set, st.integers(0, 4095)),
    st.builds(focus.Calibrate, action=st.sampled_from(list(focus.CalibrationAction))),
    st.builds(camera.Command, st.sampled_from(list(camera.CameraCommand))),
)


@settings(max_examples=50)
@given(st.lists(st.tuples(st.floats(0.0, 0.9), moves), max_size=12), st.integers(1, 20), st.booleans())
def test_looking_often_changes_nothing(script: list[tuple[float, Message]], looks: int, continuous: bool) -> None:
    seldom, often = SimulatedGimbal(continuous=continuous), SimulatedGimbal(continuous=continuous)
    host = Session()
    now, from_seldom, from_often = 0.0, b"", b""
    for wait, message in script:
        from_often += b"".join(often.advance(now + wait * step / looks) for step in range(looks))
        now += wait
        frame = host.command(message)
        for device in (seldom, often):
            device.receive(frame, now)
        from_seldom += seldom.advance(now)
        from_often += often.advance(now)
    assert from_often == from_seldom
    assert (often.angles, often.rates, often.focus) == (seldom.angles, seldom.rates, seldom.focus)


@given(st.binary(max_size=20), st.integers(0, 255), st.sampled_from([0x0D, 0x0E]), st.integers(0, 0x20))
def test_whatever_arrives_is_answered_or_ignored(value: bytes, cmd_type: int, command_set: int, command: int) -> None:
    bench = Bench()
    replies = bench.ask_raw(bytes((command_set, command)) + value, cmd_type)
    unanswered = command_set == 0x0E and (command == 0x0A or (command == 0x12 and value[:1] == b"\x01"))
    unanswered |= command_set == 0x0E and command == 0x09 and len(value) >= 8  # the version push
    wants = not cmd_type & 0x20 and cmd_type & 0x1F and not unanswered
    assert [reply[:2] for reply in replies] == ([bytes((command_set, command))] if wants else [])
    bench.wait(1.0)
    assert all(math.isfinite(angle) for angle in bench.gimbal.angles)
