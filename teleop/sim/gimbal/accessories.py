"""What hangs on a simulated gimbal: the focus motor and the camera."""

from __future__ import annotations

import math

from teleop.dji.gimbal import camera, focus
from teleop.dji.message import ReturnCode
from teleop.sim.gimbal.handlers import Answer, Handlers, timeless
from teleop.sim.gimbal.motors import Motor

FOCUS_RANGE = 4095  # counts from end to end: V2.5, section 2.3.4.19


class FocusMotor:
    """A motor on the lens with `speed` counts/s, which obeys only while it knows the ends of the lens.

    Without a motor (`absent`) every command fails; one that `ignores_zero` does nothing for position 0.
    """

    def __init__(self, speed: float, calibrated: bool, absent: bool = False, ignores_zero: bool = False) -> None:
        self._ignores_zero = ignores_zero
        self._speed = speed
        self._motor = Motor(0.0, lag=1.0, minimum=0.0, maximum=FOCUS_RANGE)
        self._calibrated_from = -math.inf if calibrated else math.inf  # s
        self._calibrating = False  # until _calibrated_from
        self._ends: set[focus.CalibrationAction] = set()
        self.handlers: Handlers = {
            focus.Set: self._set,
            focus.Calibrate: self._calibrate,
            focus.Get: self._get,
        }
        if absent:
            self.handlers = dict.fromkeys(self.handlers, timeless(lambda _message: ReturnCode.FAILED))

    def position(self, time: float) -> float:
        """Counts, exact."""
        return self._motor.at(time)[0]

    def state(self, time: float) -> focus.EndpointState:
        if time >= self._calibrated_from:
            return focus.EndpointState.CALIBRATED
        return focus.EndpointState.CALIBRATING if self._calibrating else focus.EndpointState.UNCALIBRATED

    def _set(self, message: focus.Set, now: float) -> Answer:
        if self.state(now) != focus.EndpointState.CALIBRATED or (self._ignores_zero and not message.position):
            return ReturnCode.FAILED
        distance = abs(self._motor.clamp(message.position) - self.position(now))
        if distance:
            self._motor.travel(now, message.position, distance / self._speed)
        else:
            self._motor.halt(now)
        return ReturnCode.OK

    def _get(self, message: focus.Get, now: float) -> Answer:
        return focus.GetReply(ReturnCode.OK, message.motor, self.state(now), round(self.position(now)))

    def _calibrate(self, message: focus.Calibrate, now: float) -> Answer:
        done = self._carry_out(focus.CalibrationAction(message.action), now)
        execution = focus.Execution.SUCCEEDED if done else focus.Execution.FAILED
        return focus.CalibrateReply(ReturnCode.OK, motor=message.motor, execution=execution)

    def _carry_out(self, action: focus.CalibrationAction, now: float) -> bool:
        match action:
            case focus.CalibrationAction.AUTO:
                self._sweep(now)
            case focus.CalibrationAction.MINIMUM | focus.CalibrationAction.MAXIMUM:
                self._ends.add(action)
            case focus.CalibrationAction.MANUAL:
                if len(self._ends) < 2:
                    return False
                self._ends.clear()
                self._calibrated_from, self._calibrating = now, False
            case focus.CalibrationAction.STOP if self.state(now) == focus.EndpointState.CALIBRATING:
                self._motor.halt(now)
                self._calibrated_from, self._calibrating = math.inf, False
        return True

    def _sweep(self, now: float) -> None:
        """To one end, to the other, and back to where it was."""
        start = self.position(now)
        whole = FOCUS_RANGE / self._speed
        near, back = start / self._speed, (FOCUS_RANGE - start) / self._speed
        stations = [(0.0, near), (FOCUS_RANGE, whole), (start, back)]
        self._motor.visit(now, [(target, duration) for target, duration in stations if duration > 0.0])
        self._calibrated_from, self._calibrating = now + near + whole + back, True


class Camera:
    """A camera that the gimbal triggers."""

    def __init__(self) -> None:
        self.recording = False
        self.shutter_count = 0
        self.handlers: Handlers = {
            camera.Command: timeless(self._command),
            camera.ShortCommand: timeless(self._command),
            camera.Status: timeless(self._status),
        }

    def _command(self, message: camera.Command | camera.ShortCommand) -> Answer:
        match message.command:
            case camera.CameraCommand.SHUTTER:
                self.shutter_count += 1
            case camera.CameraCommand.RECORD:
                self.recording = True
            case camera.CameraCommand.STOP:
                self.recording = False
        return ReturnCode.OK

    def _status(self, _query: camera.Status) -> Answer:
        state = camera.CameraState.RECORDING if self.recording else camera.CameraState.IDLE
        return camera.StatusReply(ReturnCode.OK, state)
