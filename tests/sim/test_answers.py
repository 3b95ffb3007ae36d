"""What the simulated gimbal answers, remembers and says unasked."""

import pytest
from sim_bench import Bench

from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message, Result, ReturnCode

OK = Result(ReturnCode.OK)
FAILED = Result(ReturnCode.FAILED)
NOT_SET = gimbal.SetParametersReply(ReturnCode.FAILED, ())
EVERY_ID = tuple(gimbal.ParameterId)


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.mark.parametrize(
    ("message", "reply"),
    [
        (gimbal.Angles(), gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 0.0, 0.0, 0.0)),
        (gimbal.Angles(gimbal.AngleKind.NONE), gimbal.AnglesReply(0, gimbal.AngleKind.NONE, 0.0, 0.0, 0.0)),
        (gimbal.Limits(), gimbal.LimitsReply(0, 145, 55, 179, 179, 30, 30)),
        (gimbal.Limits(gimbal.Operation.NOTHING), OK),
        (gimbal.SetLimits(1, 1, 1, 1, 1, 1, operation=gimbal.Operation.NOTHING), OK),
        (gimbal.Stiffness(), gimbal.StiffnessReply(0, 50, 50, 50)),
        (gimbal.Stiffness(gimbal.Operation.NOTHING), OK),
        (gimbal.Version(), gimbal.VersionReply(0, 1, "02.02.00.07")),
        (gimbal.Version(2), FAILED),
        (gimbal.Parameters(EVERY_ID), gimbal.ParametersReply(0, tuple(gimbal.Parameter(i, b"\0") for i in EVERY_ID))),
        (gimbal.Parameters((0x77,)), gimbal.ParametersReply(ReturnCode.FAILED, ())),
        (gimbal.SetParameters((gimbal.Parameter(0x77, b"\0"),)), NOT_SET),
        (gimbal.SetParameters((gimbal.Parameter(gimbal.ParameterId.MOTOR, b"\0\0"),)), NOT_SET),
        (gimbal.Orient(gimbal.Orientation.PORTRAIT), OK),
        (gimbal.Mode(mode=gimbal.FollowMode.SPORT), OK),
        (gimbal.ActiveTrack(), OK),
        (gimbal.Calibrate(), OK),
        (gimbal.Calibrate(type=0), OK),
        (gimbal.PushSettings(gimbal.Switch.UNCHANGED), OK),
        (focus.Get(), focus.GetReply(0, 0, focus.EndpointState.CALIBRATED, 0)),
        (camera.Status(), camera.StatusReply(0, camera.CameraState.IDLE)),
        (camera.Command(camera.CameraCommand.CENTER_FOCUS), OK),
    ],
)
def test_each_command_has_its_reply(bench: Bench, message: Message, reply: Message) -> None:
    assert bench.ask(message) == reply
    assert bench.gimbal.counts == {message.name: 1}


@pytest.mark.parametrize(
    "data",
    [
        "0e00",  # a position without a value
        "0e0020003000",  # half a position
        "0e0203",  # a kind of angle that there is not
        "0e0300",  # limits without limits
        "0e0301ff0000000000",  # pitch 255 degrees
        "0e0501650000",  # stiffness 101 %
        "0e0703",  # neither on nor off
        "0e0dfe09",  # no such orientation
        "0e0d0001",  # an orientation with a mode
        "0e0efe00",  # neither mode nor action
        "0e0e0201",  # both
        "0e0e0700",  # no such mode
        "0e0f000105",  # tuning type 2
        "0e0c",  # no parameter
        "0e0c2302",  # a parameter without its bytes
        "0e1100",  # track what?
        "0e12020009",  # no such calibration
        "0e121501",  # no such motor
        "0e1299",  # no such sub id
        "0d000700",  # no such camera command
        "0d0102",  # no such question
        "0e7f",  # no such command
        "7700",  # no such set
        "0e",
    ],
)
def test_what_is_malformed_or_not_in_the_document_is_a_parse_error(bench: Bench, data: str) -> None:
    sent = bytes.fromhex(data)
    assert bench.ask_raw(sent) == [sent[:2] + b"\x01"]


def test_a_stream_is_never_answered(bench: Bench) -> None:
    for message in (gimbal.Joystick(1, 2, 3), gimbal.Dial(100), focus.Set(7), gimbal.VersionPush("01.02.03.04")):
        bench.tell(message)
    assert bench.listen() == []
    assert bench.unasked == []
    assert bench.gimbal.settings.host_version == "01.02.03.04"


def test_a_reply_is_no_command(bench: Bench) -> None:
    assert bench.ask_raw(bytes.fromhex("0e0000"), cmd_type=0x20) == []
    assert not bench.gimbal.counts


def test_old_firmware_answers_without_set_and_id() -> None:
    bench = Bench(bare_replies=True, boot=(1.0, 2.0, 3.0))
    assert bench.ask_raw(b"\x0e\x02\x01") == [bytes.fromhex("00 01 0a00 1400 1e00")]
    assert bench.ask(gimbal.Angles()) == gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 1.0, 2.0, 3.0)
    assert bench.ask(gimbal.PushSettings(gimbal.Switch.OFF)) == OK


def test_settings_are_remembered(bench: Bench) -> None:
    assert bench.ask(gimbal.SetStiffness(10, 20, 30)) == OK
    assert bench.ask(gimbal.Stiffness()) == gimbal.StiffnessReply(0, pitch=10, yaw=30, roll=20)
    bench.ask(gimbal.SetStiffness(1, 2, 3, operation=gimbal.Operation.NOTHING))
    assert bench.ask(gimbal.Stiffness()) == gimbal.StiffnessReply(0, pitch=10, yaw=30, roll=20)
    given = (gimbal.Parameter(gimbal.ParameterId.FOLLOW_SPECIAL, b"\x10"), gimbal.Parameter(0x14, b"\x01"))
    bench.ask(gimbal.SetParameters(given))
    assert bench.ask(gimbal.Parameters((0x22, 0x14))) == gimbal.ParametersReply(0, given)


def test_modes_are_remembered(bench: Bench) -> None:
    bench.ask(gimbal.Mode(mode=gimbal.FollowMode.LOCK))
    assert bench.gimbal.follow == gimbal.FollowMode.LOCK
    for asked, stands in (("PORTRAIT", "PORTRAIT"), ("UNCHANGED", "PORTRAIT"), ("DEFAULT", "LANDSCAPE")):
        bench.ask(gimbal.Orient(gimbal.Orientation[asked]))
        assert bench.gimbal.settings.orientation.name == stands
    states = []
    for _ in range(3):
        bench.ask(gimbal.ActiveTrack())
        states.append(bench.gimbal.settings.tracking)
    assert states == [True, False, True]


def test_pushes_come_at_their_rate_while_they_are_on() -> None:
    bench = Bench(push_rate=25.0, boot=(1.0, 2.0, 3.0))
    bench.ask(gimbal.SetStiffness(10, 20, 30))
    bench.wait(1.0)
    assert bench.unasked == []
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.wait(0.999)
    assert len(bench.unasked) == 24
    assert bench.unasked[-1] == gimbal.Push(
        True, True, True, 1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 145, 55, 179, 179, 30, 30, 10, 30, 20
    )
    bench.ask(gimbal.PushSettings(gimbal.Switch.UNCHANGED))
    bench.wait(0.5)
    assert len(bench.unasked) == 37
    bench.ask(gimbal.PushSettings(gimbal.Switch.OFF))
    bench.wait(5.0)
    assert len(bench.unasked) == 37


def test_a_push_says_where_it_was_at_its_own_time(bench: Bench) -> None:
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.ask(gimbal.Position(10.0, 0.0, 0.0, time_for_action=1.0))
    bench.wait(1.0)
    yaws = [push.yaw for push in bench.unasked if isinstance(push, gimbal.Push)]
    assert yaws == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]


def test_a_calibration_pushes_its_progress_and_forbids_motion(bench: Bench) -> None:
    bench.ask(gimbal.Calibrate())
    assert bench.ask(gimbal.Position(10.0, 0.0, 0.0)) == FAILED
    for _ in range(20):
        bench.wait(0.75)
    pushes = [push for push in bench.unasked if isinstance(push, gimbal.Calibration)]
    assert [push.progress for push in pushes] == [5 * step for step in range(1, 21)]
    running, complete = gimbal.CalibrationState.RUNNING, gimbal.CalibrationState.COMPLETE
    assert [push.state for push in pushes] == [running] * 19 + [complete]
    assert bench.ask(gimbal.Position(10.0, 0.0, 0.0)) == OK


def test_a_calibration_can_be_stopped(bench: Bench) -> None:
    bench.ask(gimbal.Calibrate())
    bench.wait(0.9)
    bench.ask(gimbal.Calibrate(start=False))
    bench.wait(5.0)
    assert [push.fields()["state"] for push in bench.unasked] == ["running", "none"]
    assert bench.ask(gimbal.Position(10.0, 0.0, 0.0)) == OK
    assert bench.ask(gimbal.Calibrate(start=False)) == OK


def test_the_focus_motor_turns_at_its_own_speed() -> None:
    bench = Bench(focus_speed=1000.0)
    bench.tell(focus.Set(3000))
    bench.wait(1.0)
    assert bench.gimbal.focus == 1000.0
    bench.tell(focus.Set(0))
    bench.wait(0.5)
    assert bench.ask(focus.Get()) == focus.GetReply(0, 0, focus.EndpointState.CALIBRATED, 500)
    bench.wait(5.0)
    bench.tell(focus.Set(0))
    assert bench.gimbal.focus == 0.0


def test_an_uncalibrated_focus_motor_ignores_positions() -> None:
    bench = Bench(focus_calibrated=False, focus_speed=4095.0)
    bench.tell(focus.Set(3000))
    bench.wait(5.0)
    assert bench.ask(focus.Get()) == focus.GetReply(0, 0, focus.EndpointState.UNCALIBRATED, 0)


def calibrate(bench: Bench, action: focus.CalibrationAction) -> focus.Execution:
    reply = bench.ask(focus.Calibrate(action=action))
    assert isinstance(reply, focus.CalibrateReply)
    return focus.Execution(reply.execution)


def endpoints(bench: Bench) -> focus.EndpointState:
    reply = bench.ask(focus.Get())
    assert isinstance(reply, focus.GetReply)
    return focus.EndpointState(reply.calibration)


def test_the_focus_motor_calibrates_by_itself() -> None:
    bench = Bench(focus_calibrated=False, focus_speed=4095.0)
    assert calibrate(bench, focus.CalibrationAction.AUTO) == focus.Execution.SUCCEEDED
    positions = []
    for _ in range(4):
        bench.wait(0.49)
        positions.append(bench.gimbal.focus)
        assert endpoints(bench) == focus.EndpointState.CALIBRATING
    assert max(positions) > 4000.0
    bench.tell(focus.Set(3000))
    bench.wait(0.05)
    assert endpoints(bench) == focus.EndpointState.CALIBRATED
    assert bench.gimbal.focus == 0.0


def test_the_focus_motor_is_calibrated_by_hand_from_both_ends() -> None:
    bench = Bench(focus_calibrated=False)
    assert calibrate(bench, focus.CalibrationAction.MANUAL) == focus.Execution.FAILED
    assert calibrate(bench, focus.CalibrationAction.MINIMUM) == focus.Execution.SUCCEEDED
    assert calibrate(bench, focus.CalibrationAction.MANUAL) == focus.Execution.FAILED
    assert calibrate(bench, focus.CalibrationAction.MAXIMUM) == focus.Execution.SUCCEEDED
    assert endpoints(bench) == focus.EndpointState.UNCALIBRATED
    assert calibrate(bench, focus.CalibrationAction.MANUAL) == focus.Execution.SUCCEEDED
    assert endpoints(bench) == focus.EndpointState.CALIBRATED


def test_a_focus_calibration_can_be_stopped() -> None:
    bench = Bench(focus_calibrated=False, focus_speed=4095.0)
    calibrate(bench, focus.CalibrationAction.AUTO)
    bench.wait(0.5)
    assert calibrate(bench, focus.CalibrationAction.STOP) == focus.Execution.SUCCEEDED
    here = bench.gimbal.focus
    bench.wait(5.0)
    assert bench.gimbal.focus == here
    assert endpoints(bench) == focus.EndpointState.UNCALIBRATED


@pytest.mark.parametrize("command", [camera.Command, camera.ShortCommand])
def test_the_camera_records_and_takes_pictures(bench: Bench, command: type[camera.Command]) -> None:
    assert bench.ask(command(camera.CameraCommand.RECORD)) == OK
    assert bench.gimbal.recording
    assert bench.ask(camera.Status()) == camera.StatusReply(0, camera.CameraState.RECORDING)
    bench.ask(command(camera.CameraCommand.STOP))
    assert not bench.gimbal.recording
    for _ in range(3):
        bench.ask(command(camera.CameraCommand.SHUTTER))
        bench.ask(command(camera.CameraCommand.STOP_SHUTTER))
    assert bench.gimbal.shutter_count == 3
