"""The focus motor and the camera on a simulated gimbal: docs/protocol-facts.md, 0E 12 and 0D 00."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal.camera import CameraCommand, CameraState
from teleop.dji.gimbal.focus import CalibrationAction, EndpointState, Execution
from teleop.dji.message import Message, ReturnCode
from teleop.sim.gimbal.accessories import Camera, FocusMotor

SPEED = 1000.0  # counts/s


def obey(device: FocusMotor | Camera, message: Message, now: float = 0.0) -> Any:
    return device.handlers[type(message)](message, now)


def calibrate(motor: FocusMotor, action: CalibrationAction, now: float = 0.0) -> Execution:
    return obey(motor, focus.Calibrate(action), now).execution


def test_it_turns_at_its_own_speed_and_says_where_it_is() -> None:
    motor = FocusMotor(SPEED, calibrated=True)
    assert obey(motor, focus.Set(3000)) == ReturnCode.OK
    assert obey(motor, focus.Get(), 1.5).position == 1500
    assert obey(motor, focus.Get(), 9.0).position == 3000
    obey(motor, focus.Set(2000), 9.0)
    assert motor.position(9.5) == pytest.approx(2500)


def test_a_motor_that_is_not_calibrated_ignores_positions() -> None:
    motor = FocusMotor(SPEED, calibrated=False)
    assert obey(motor, focus.Set(3000)) == ReturnCode.FAILED
    reply = obey(motor, focus.Get(), 9.0)
    assert (reply.position, reply.calibration) == (0, EndpointState.UNCALIBRATED)


def test_some_motors_ignore_position_0_and_no_other() -> None:
    motor = FocusMotor(SPEED, calibrated=True, ignores_zero=True)
    obey(motor, focus.Set(100))
    obey(motor, focus.Set(0), 5.0)
    assert motor.position(9.0) == pytest.approx(100)
    obey(motor, focus.Set(1), 9.0)
    assert motor.position(12.0) == pytest.approx(1)


def test_without_a_motor_everything_fails() -> None:
    motor = FocusMotor(SPEED, calibrated=True, absent=True)
    for message in (focus.Set(1), focus.Get(), focus.Calibrate(CalibrationAction.AUTO)):
        assert obey(motor, message) == ReturnCode.FAILED


def test_automatic_calibration_takes_the_lens_to_both_ends_and_back() -> None:
    motor = FocusMotor(4095.0, calibrated=False)
    assert calibrate(motor, CalibrationAction.AUTO) == Execution.SUCCEEDED
    assert motor.state(1.0) == EndpointState.CALIBRATING
    assert motor.position(1.0) == pytest.approx(4095)
    assert motor.state(2.0) == EndpointState.CALIBRATED
    assert motor.position(2.0) == pytest.approx(0)


def test_a_calibration_that_is_stopped_has_no_result() -> None:
    motor = FocusMotor(4095.0, calibrated=False)
    calibrate(motor, CalibrationAction.AUTO)
    calibrate(motor, CalibrationAction.STOP, 0.5)
    assert motor.state(9.0) == EndpointState.UNCALIBRATED
    assert motor.position(9.0) == pytest.approx(4095 / 2)


def test_calibration_by_hand_needs_both_ends() -> None:
    motor = FocusMotor(SPEED, calibrated=False)
    calibrate(motor, CalibrationAction.MINIMUM)
    assert calibrate(motor, CalibrationAction.MANUAL) == Execution.FAILED
    calibrate(motor, CalibrationAction.MAXIMUM)
    assert calibrate(motor, CalibrationAction.MANUAL, 3.0) == Execution.SUCCEEDED
    assert motor.state(3.0) == EndpointState.CALIBRATED
    assert calibrate(motor, CalibrationAction.MANUAL, 4.0) == Execution.FAILED, "the ends are forgotten"


@pytest.mark.parametrize("kind", [camera.Command, camera.ShortCommand])
def test_the_camera_is_told_in_two_bytes_or_in_one(kind: type[camera.Command]) -> None:
    device = Camera()
    assert obey(device, camera.Status()).state == CameraState.IDLE
    for command in (CameraCommand.RECORD, CameraCommand.SHUTTER, CameraCommand.STOP_SHUTTER):
        assert obey(device, kind(command)) == ReturnCode.OK
    assert (obey(device, camera.Status()).state, device.shutter_count) == (CameraState.RECORDING, 1)
    obey(device, kind(CameraCommand.STOP))
    assert obey(device, camera.Status()).state == CameraState.IDLE
