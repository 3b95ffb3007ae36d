"""What a simulated drone makes of each message: obeys it, or refuses it with a reason.

A command is a row in a table. It is read as generously as real ones read: bytes whose value is "arbitrary" may have
any, reserved bits are not looked at, and of the virtual RC's channels only those count that mean something.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import (
    ActivationCode,
    ArmCode,
    ArmOrder,
    Code,
    ControlCode,
    ControlOrder,
    CurrentMode,
    Rate,
    TaskCode,
    TaskKind,
    TaskResultCode,
)
from teleop.dji.drone.movement import COMBINATIONS, Move
from teleop.dji.drone.virtual_rc import Sticks, VirtualRc
from teleop.dji.message import FieldError, Message, Opaque
from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.commands import controls, move, out_of_range
from teleop.sim.drone.controls import Pilot, Switch, TaskState
from teleop.sim.drone.payload import Payload
from teleop.sim.drone.settings import DroneSettings
from teleop.sim.drone.telemetry import TelemetrySender
from teleop.sim.gimbal.handlers import without_reserved
from teleop.sim.refusals import Why, command_name

PARAMETER_ERROR: Final = 1  # of 00 10: OPENProtocol.md 3.1.9
VERSION: Final = drone.VersionAck(  # of a real M100: docs/protocol-facts.md, OSDK issue 54
    Code.NOT_ACTIVATED, 0xA6453AAC, "041D492163", "SDK-v1.0 BETA M100-03.01.01.00"
)
_ARBITRARY: Final = {  # their one byte may be any: OPENProtocol.md 3.1.9
    cls.set_and_id: cls for cls in (drone.Version, drone.Photo, drone.StartVideo, drone.StopVideo)
}
_READ_GENEROUSLY: Final = drone.Frequency, VirtualRc, Sticks, drone.Activate
_FIRST: Final = drone.Version, drone.Activate
_LOCKS_IT: Final = "enabled again within 2 s: its RC cannot end this"
_RESULTS: Final = {
    TaskState.RUNNING: TaskResultCode.IN_PROGRESS,
    TaskState.FAILED: TaskResultCode.FAILED,
    TaskState.SUCCEEDED: TaskResultCode.SUCCEEDED,
}


class DroneHandlers:
    """`refuse` is called with the name of a command, why it is not obeyed, and more about it."""

    def __init__(
        self,
        autopilot: Autopilot,
        telemetry: TelemetrySender,
        settings: DroneSettings,
        refuse: Callable[[str, Why, str], object],
    ) -> None:
        self.activated = False
        self.payload = Payload()
        self._autopilot, self._telemetry, self._settings = autopilot, telemetry, settings
        self._refuse = refuse
        self._asked: ControlOrder | None = None  # what has to be sent again to be confirmed
        self._task_number: int | None = None
        self.handlers: dict[type[Message], Callable[[Any], Message | None]] = {
            drone.Version: self._version,
            drone.Activate: self._activate,
            drone.Frequency: self._set_frequency,
            drone.Control: self._control,
            drone.Task: self._task,
            drone.TaskResult: self._task_result,
            drone.Arm: self._arm,
            Move: self._move,
            VirtualRc: self._virtual_rc,
            Sticks: self._sticks,
            drone.GimbalSpeed: lambda message: self.payload.turn(message, autopilot.time),
            drone.GimbalAngle: self._point_gimbal,
            drone.Photo: self._photo,
            drone.StartVideo: lambda _: self._record(True),
            drone.StopVideo: lambda _: self._record(False),
        }

    def answer(self, message: Message) -> Message | None:
        """Obey a message or refuse it; what acknowledges it, if anything does."""
        if isinstance(message, Opaque):
            known = _ARBITRARY.get(message.prefix)
            if known is None or len(message.value) != 1:
                return self._answer_unknown(message)
            message = known()
        handler = self.handlers.get(type(message))
        if handler is None:
            return self._refused(message, Why.UNKNOWN)
        if not self.activated and not self._goes_before_activation(message):
            return self._refused(message, Why.NOT_ACTIVATED, answer=NOT_ACTIVATED.get(type(message)))
        if not isinstance(message, _READ_GENEROUSLY):
            try:
                without_reserved(message).check()
            except FieldError as error:
                failed = drone.TaskAck(TaskCode.FAILED) if isinstance(message, drone.Task) else None
                return self._refused(message, Why.RANGE, str(error).partition(": ")[2], failed)
        return handler(message)

    def knows(self, message: Message) -> bool:
        """Whether it is one of its commands, whatever its length."""
        return any(cls.set_and_id == message.data()[:2] for cls in self.handlers)

    def _goes_before_activation(self, message: Message) -> bool:
        early = isinstance(message, drone.Frequency) and self._settings.broadcasts_before_activation
        return early or isinstance(message, _FIRST)

    def _refused(self, message: Message, why: Why, detail: str = "", answer: Message | None = None) -> Message | None:
        self._refuse(command_name(message), why, detail)
        return answer

    def _answer_unknown(self, message: Opaque) -> Message | None:
        if not self.knows(message):
            return self._refused(message, Why.UNKNOWN)
        named = next(cls for cls in self.handlers if cls.set_and_id == message.prefix)
        self._refuse(named.name, Why.LENGTH, f"{len(message.value)} bytes, not {named.layout.size}")
        return drone.FrequencyAck(PARAMETER_ERROR) if named is drone.Frequency else None

    def _version(self, _query: drone.Version) -> Message:
        code = Code.OK if self.activated else Code.NOT_ACTIVATED
        return drone.VersionAck(code, VERSION.checksum, VERSION.id, VERSION.version)

    def _activate(self, _message: drone.Activate) -> Message:
        self.activated = True
        self._telemetry.begin(self._autopilot.time)
        return drone.ActivateAck(ActivationCode.OK)

    def _set_frequency(self, message: drone.Frequency) -> Message | None:
        unknown = [part for part in self._telemetry.rates if not isinstance(getattr(message, part), Rate)]
        if unknown:
            detail = f"{unknown[0]} must be 0..5, not {getattr(message, unknown[0])}"
            return self._refused(message, Why.RANGE, detail, drone.FrequencyAck(PARAMETER_ERROR))
        self._telemetry.set(message)
        return drone.FrequencyAck(Code.OK)

    def _control(self, message: drone.Control) -> Message | None:
        """Each order is confirmed when it comes for the second time (OPENProtocol.md 3.1.9, 01 00)."""
        autopilot, obtains = self._autopilot, message.order == ControlOrder.OBTAIN
        if obtains and not autopilot.may_obtain:
            self._asked = None
            answer = drone.ControlAck(ControlCode.NOT_IN_F_MODE)
            return self._refused(message, Why.MODE, "the RC's mode switch is not in F", answer)
        if self._settings.asks_twice and autopilot.obtained != obtains and self._asked != message.order:
            self._asked = ControlOrder(message.order)
            return drone.ControlAck(ControlCode.OBTAINING if obtains else ControlCode.RELEASING)
        self._asked = None
        if obtains:
            autopilot.obtain()
            return drone.ControlAck(ControlCode.OBTAINED)
        autopilot.release()
        return drone.ControlAck(ControlCode.RELEASED)

    def _task(self, message: drone.Task) -> Message | None:
        """Without control it fails as any other (the maker's sample LinuxFlight.cpp, takeoff and landing)."""
        autopilot = self._autopilot
        starts = {
            TaskKind.RETURN_HOME: autopilot.go_home,
            TaskKind.TAKE_OFF: autopilot.take_off,
            TaskKind.LAND: autopilot.land,
        }
        if not autopilot.obtained:
            return self._refused(message, Why.NO_CONTROL, answer=drone.TaskAck(TaskCode.FAILED))
        if not starts[TaskKind(message.task)]():
            where = "the motors run or it is in the air" if message.task == TaskKind.TAKE_OFF else "it is on the ground"
            return self._refused(message, Why.STATE, where, drone.TaskAck(TaskCode.FAILED))
        self._task_number = message.number
        return drone.TaskAck(TaskCode.STARTED)

    def _task_result(self, message: drone.TaskResult) -> Message | None:
        """Of the last task that started: "Request Switch Result"."""
        if message.number != self._task_number:
            detail = f"number {message.number}: the last task is {self._task_number}"
            return self._refused(message, Why.RANGE, detail, drone.TaskResultAck(TaskResultCode.WRONG_NUMBER))
        return drone.TaskResultAck(_RESULTS[self._autopilot.task])

    def _arm(self, message: drone.Arm) -> Message | None:
        flight, arms = self._autopilot.flight, message.order == ArmOrder.ARM
        if not self._autopilot.obtained:
            return self._refused(message, Why.NO_CONTROL, answer=drone.ArmAck(ArmCode.NEED_CONTROL))
        if flight.motors == arms:
            detail = "the motors run already" if arms else "the motors are off already"
            return self._refused(message, Why.STATE, detail, drone.ArmAck(ArmCode.ALREADY))
        if flight.airborne:
            return self._refused(message, Why.STATE, "it is in the air", drone.ArmAck(ArmCode.IN_THE_AIR))
        if arms:
            flight.start_motors()
        else:
            flight.stop_motors()
        return drone.ArmAck(ArmCode.OK)

    def _move(self, message: Move) -> Message | None:
        autopilot = self._autopilot
        if not autopilot.obtained:
            return self._refused(message, Why.NO_CONTROL)
        if autopilot.pilot is not Pilot.ONBOARD:
            return self._refused(message, Why.MODE, f"it is flown by {autopilot.pilot.value}")
        assert message.combination is not None
        self._telemetry.mode = CurrentMode(COMBINATIONS.index(message.combination) + 1)
        autopilot.moves(lambda flight: move(flight, message))
        return None

    def _virtual_rc(self, message: VirtualRc) -> Message | None:
        autopilot, locked = self._autopilot, self._autopilot.locked
        if message.on:
            autopilot.enable_virtual(message.back_to_rc)
        else:
            autopilot.disable_virtual(message.back_to_rc)
        if autopilot.locked:
            return self._refused(message, Why.STATE, "it is locked" if locked else _LOCKS_IT)
        if message.on and autopilot.rc.switch is not Switch.F:
            return self._refused(message, Why.MODE, "the RC's mode switch is not in F")
        return None

    def _sticks(self, message: Sticks) -> Message | None:
        """Only 0 to 3, 4 and 6 mean anything; clients leave the rest unset (docs/protocol-facts.md)."""
        if detail := out_of_range(message):
            return self._refused(message, Why.RANGE, detail)
        if not self._autopilot.virtual_on:
            return self._refused(message, Why.MODE, "virtual RC is off")
        if self._autopilot.locked:
            return self._refused(message, Why.STATE, "it is locked")
        self._autopilot.virtual_sticks(controls(message, self._autopilot.virtual))
        return None

    def _point_gimbal(self, message: drone.GimbalAngle) -> Message | None:
        if detail := self.payload.outside(message):
            return self._refused(message, Why.RANGE, detail)
        self.payload.point(message, self._autopilot.time)
        return None

    def _photo(self, _message: drone.Photo) -> None:
        self.payload.photos += 1

    def _record(self, recording: bool) -> None:
        self.payload.recording = recording


NOT_ACTIVATED: Final[dict[type[Message], Message]] = {
    drone.Frequency: drone.FrequencyAck(Code.NOT_ACTIVATED),
    drone.Control: drone.ControlAck(ControlCode.NOT_ACTIVATED),
    drone.Task: drone.TaskAck(TaskCode.NOT_ACTIVATED),
    drone.TaskResult: drone.TaskResultAck(TaskResultCode.NOT_ACTIVATED),
    drone.Arm: drone.ArmAck(ArmCode.NOT_ACTIVATED),
}
