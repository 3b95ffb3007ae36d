"""What a simulated gimbal remembers, other than where it is: stiffness, user parameters, modes, its own version."""

from __future__ import annotations

from typing import Any

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import ReturnCode
from teleop.sim.gimbal.handlers import Answer, Handlers, timeless

_PARAMETER_SIZE = 1  # bytes, of every known user parameter: V2.5, section 2.3.4.12

DOCUMENTED_PARAMETERS = 0x00, 0x22, 0x23  # V2.5, figure 23; their reply was observed to have 28 bytes


class Settings:
    """Settable and askable; none but `asleep` changes how the gimbal moves."""

    def __init__(self, version: str) -> None:
        self.version = version
        self.stiffness: dict[str, Any] = {"pitch": 50, "roll": 50, "yaw": 50}  # %
        self.parameters = {int(known): bytes(_PARAMETER_SIZE) for known in gimbal.ParameterId}
        self.orientation = gimbal.Orientation.LANDSCAPE
        self.tracking = False
        self.host_version: str | None = None  # as the other end pushes it
        self.handlers: Handlers = {
            gimbal.SetStiffness: timeless(self._set_stiffness),
            gimbal.Stiffness: timeless(self._report_stiffness),
            gimbal.Version: timeless(self._report_version),
            gimbal.VersionPush: timeless(self._take_version),
            gimbal.Parameters: timeless(self._report_parameters),
            gimbal.SetParameters: timeless(self._set_parameters),
            gimbal.Orient: timeless(self._orient),
            gimbal.ActiveTrack: timeless(self._track),
            gimbal.Dial: timeless(lambda _dial: ReturnCode.OK),
        }

    @property
    def asleep(self) -> bool:
        """Whether the motors are off: bit 0 of the motor parameter."""
        return bool(self.parameters[gimbal.ParameterId.MOTOR][0] & 1)

    def _set_stiffness(self, message: gimbal.SetStiffness) -> Answer:
        if message.operation == gimbal.Operation.EXECUTE:
            self.stiffness: dict[str, Any] = {"pitch": message.pitch, "roll": message.roll, "yaw": message.yaw}
        return ReturnCode.OK

    def _report_stiffness(self, message: gimbal.Stiffness) -> Answer:
        if message.operation == gimbal.Operation.NOTHING:
            return ReturnCode.OK
        return gimbal.StiffnessReply(ReturnCode.OK, **self.stiffness)

    def _report_version(self, message: gimbal.Version) -> Answer:
        if message.device != gimbal.R_SDK_DEVICE:
            return ReturnCode.FAILED
        return gimbal.VersionReply(ReturnCode.OK, message.device, self.version)

    def _take_version(self, message: gimbal.VersionPush) -> Answer:
        self.host_version = message.version
        return ReturnCode.OK

    def _report_parameters(self, message: gimbal.Parameters) -> Answer:
        ids = message.ids or DOCUMENTED_PARAMETERS  # clients ask for none
        if not set(ids) <= self.parameters.keys():
            return ReturnCode.FAILED
        known = tuple(gimbal.Parameter(number, self.parameters[number]) for number in ids)
        return gimbal.ParametersReply(ReturnCode.OK, known)

    def _set_parameters(self, message: gimbal.SetParameters) -> Answer:
        if not message.parameters or message.extra:
            return ReturnCode.PARSE_ERROR
        if any(each.id not in self.parameters or len(each.value) != _PARAMETER_SIZE for each in message.parameters):
            return ReturnCode.FAILED
        self.parameters.update({each.id: each.value for each in message.parameters})
        return gimbal.SetParametersReply(ReturnCode.OK, message.parameters)

    def _orient(self, message: gimbal.Orient) -> Answer:
        turned = {
            gimbal.Orientation.UNCHANGED: self.orientation,
            gimbal.Orientation.DEFAULT: gimbal.Orientation.LANDSCAPE,
        }
        wanted = gimbal.Orientation(message.orientation)
        self.orientation = turned.get(wanted, wanted)
        return ReturnCode.OK

    def _track(self, _toggle: gimbal.ActiveTrack) -> Answer:
        self.tracking = not self.tracking
        return ReturnCode.OK
