"""Command set 0x0E without the focus motor: every command, query and push of the handheld gimbal itself.

Fields follow the tables of V2.5 section 2.3.4 with the corrections of docs/protocol-facts.md: above all,
the axis order differs from message to message, on purpose. Signs are the gimbal's own; a profile maps them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Any, ClassVar, Final

from teleop.dji.fields import I16, U8, U32, Bits, DottedVersion, Flag, Reserved
from teleop.dji.gimbal.enums import (
    AngleKind,
    CalibrationState,
    CenterAction,
    FollowMode,
    Operation,
    Orientation,
    ParameterId,
    Switch,
    Track,
)
from teleop.dji.gimbal.tlv import Ids, OptionalByte, Parameter, Tlv
from teleop.dji.gimbal.unnamed_axes import ignoring, resting
from teleop.dji.message import STREAM, FieldError, Message, message, result_code

GIMBAL: Final = 0x0E  # command set, section 2.3.1
R_SDK_DEVICE: Final = 0x00000001  # section 2.3.3

decidegrees = Annotated[float, I16(scale=10, unit="deg")]
yaw_decidegrees = Annotated[float, I16(scale=10, unit="deg", low=-180, high=180)]
roll_decidegrees = Annotated[float, I16(scale=10, unit="deg", low=-30, high=30)]
pitch_decidegrees = Annotated[float, I16(scale=10, unit="deg", low=-56, high=146)]
decidegrees_per_second = Annotated[float, I16(scale=10, unit="deg/s", low=-360, high=360)]
pitch_limit_up = Annotated[int, U8(unit="deg", low=0, high=145)]
pitch_limit_down = Annotated[int, U8(unit="deg", low=0, high=55)]
yaw_limit = Annotated[int, U8(unit="deg", low=0, high=179)]
roll_limit = Annotated[int, U8(unit="deg", low=0, high=30)]
percent = Annotated[int, U8(unit="%", low=0, high=100)]
stick = Annotated[int, I16(low=-15000, high=15000)]
byte = Annotated[int, U8()]
device_id = Annotated[int, U32()]
dotted = Annotated[str, DottedVersion()]
whether = Annotated[int, U8(words=Operation)]
whether_or_absent = Annotated[int | None, OptionalByte(Operation)]  # some clients ask without data
tlv = Annotated[tuple[Parameter, ...], Tlv(ParameterId)]
angle_kind = Annotated[int, U8(words=AngleKind)]


@message("gimbal.position", GIMBAL, 0x00)
class Position(Message):
    """Turn to these angles, or by these angles when not `absolute`, at constant speed within `time_for_action`.

    An axis that is not named is ignored. The default time is that of the document's own sample (section 3.3).
    """

    yaw: yaw_decidegrees
    roll: roll_decidegrees
    pitch: pitch_decidegrees
    absolute: Annotated[bool, Flag(first=0)] = True
    yaw_ignored: Annotated[bool, Flag(first=1)] = False
    roll_ignored: Annotated[bool, Flag(first=2)] = False
    pitch_ignored: Annotated[bool, Flag(first=3)] = False
    reserved: Annotated[int, Reserved()] = 0
    time_for_action: Annotated[float, U8(scale=10, unit="s", low=0.1, high=25.5)] = 2.0

    @classmethod
    def completed(cls, fields: Mapping[str, Any]) -> Mapping[str, Any]:
        return ignoring(fields)


@message("gimbal.speed", GIMBAL, 0x01)
class Speed(Message):
    """Turn at these speeds for 0.5 s; without `take_over`, release speed control. An axis that is not named gets 0."""

    yaw: decidegrees_per_second
    roll: decidegrees_per_second
    pitch: decidegrees_per_second
    take_over: Annotated[bool, Flag(first=7)] = True
    ignore_focal_length: Annotated[bool, Flag(first=3)] = False
    reserved: Annotated[int, Reserved()] = 0

    @classmethod
    def completed(cls, fields: Mapping[str, Any]) -> Mapping[str, Any]:
        return resting(fields)


@message("gimbal.angles", GIMBAL, 0x02)
class Angles(Message):
    """Ask for the angles."""

    kind: angle_kind = AngleKind.ATTITUDE


@message("gimbal.angles", GIMBAL, 0x02, reply=True)
class AnglesReply(Message):
    """The angles, unless `kind` is NONE: then they are not ready."""

    return_code: result_code
    kind: angle_kind
    yaw: decidegrees
    roll: decidegrees
    pitch: decidegrees


@message("gimbal.legacy_angles", GIMBAL, 0x02, reply=True)
class LegacyAnglesReply(Message):
    """The angles as some old firmware answers: without the type byte. Which angle is which differs: `legacy_angles`."""

    return_code: result_code
    yaw: decidegrees
    roll: decidegrees
    pitch: decidegrees


@message("gimbal.set_limits", GIMBAL, 0x03)
class SetLimits(Message):
    """How far each axis may go from its center, each way; all magnitudes."""

    operation: whether = field(default=Operation.EXECUTE, kw_only=True)
    pitch_max: pitch_limit_up
    pitch_min: pitch_limit_down
    yaw_max: yaw_limit
    yaw_min: yaw_limit
    roll_max: roll_limit
    roll_min: roll_limit


@message("gimbal.limits", GIMBAL, 0x04)
class Limits(Message):
    """Ask how far each axis may go."""

    operation: whether_or_absent = Operation.EXECUTE


@message("gimbal.limits", GIMBAL, 0x04, reply=True)
class LimitsReply(Message):
    """As SetLimits."""

    return_code: result_code
    pitch_max: pitch_limit_up
    pitch_min: pitch_limit_down
    yaw_max: yaw_limit
    yaw_min: yaw_limit
    roll_max: roll_limit
    roll_min: roll_limit


@message("gimbal.set_stiffness", GIMBAL, 0x05)
class SetStiffness(Message):
    """Motor stiffness. The order is not that of the reply."""

    operation: whether = field(default=Operation.EXECUTE, kw_only=True)
    pitch: percent
    roll: percent
    yaw: percent


@message("gimbal.stiffness", GIMBAL, 0x06)
class Stiffness(Message):
    """Ask for the motor stiffness."""

    operation: whether_or_absent = Operation.EXECUTE


@message("gimbal.stiffness", GIMBAL, 0x06, reply=True)
class StiffnessReply(Message):
    """Motor stiffness. The order is not that of SetStiffness."""

    return_code: result_code
    pitch: percent
    yaw: percent
    roll: percent


@message("gimbal.push_settings", GIMBAL, 0x07)
class PushSettings(Message):
    """Switch the push of parameters on or off."""

    switch: Annotated[int, U8(words=Switch)]


@message("gimbal.push", GIMBAL, 0x08, reply=None, cmd_type=STREAM)
class Push(Message):
    """Everything the gimbal says of itself unasked; a group whose `_valid` is false means nothing.

    It begins with the flags, not with a return code, even when it has the reply bit.
    """

    angles_valid: Annotated[bool, Flag(first=0)]
    limits_valid: Annotated[bool, Flag(first=1)]
    stiffness_valid: Annotated[bool, Flag(first=2)]
    reserved: Annotated[int, Reserved()] = field(default=0, kw_only=True)
    yaw: decidegrees
    roll: decidegrees
    pitch: decidegrees
    joint_yaw: decidegrees
    joint_roll: decidegrees
    joint_pitch: decidegrees
    pitch_max: pitch_limit_up
    pitch_min: pitch_limit_down
    yaw_max: yaw_limit
    yaw_min: yaw_limit
    roll_max: roll_limit
    roll_min: roll_limit
    pitch_stiffness: percent
    yaw_stiffness: percent
    roll_stiffness: percent


@message("gimbal.short_push", GIMBAL, 0x08, reply=None, cmd_type=STREAM)
class ShortPush(Message):
    """A push that ends early, as one gimbal in the field sends it: the flags and the attitude; more is in `extra`."""

    angles_valid: Annotated[bool, Flag(first=0)]
    limits_valid: Annotated[bool, Flag(first=1)]
    stiffness_valid: Annotated[bool, Flag(first=2)]
    reserved: Annotated[int, Reserved()] = field(default=0, kw_only=True)
    yaw: decidegrees
    roll: decidegrees
    pitch: decidegrees


@message("gimbal.version_push", GIMBAL, 0x09, cmd_type=STREAM)
class VersionPush(Message):
    """Tell the gimbal our own version, once a second."""

    device: device_id = field(default=R_SDK_DEVICE, kw_only=True)
    version: dotted


@message("gimbal.version", GIMBAL, 0x09)
class Version(Message):
    """Ask for the version of a device."""

    device: device_id = R_SDK_DEVICE


@message("gimbal.version", GIMBAL, 0x09, reply=True)
class VersionReply(Message):
    """The version of a device."""

    return_code: result_code
    device: device_id
    version: dotted


@message("gimbal.joystick", GIMBAL, 0x0A, cmd_type=STREAM)
class Joystick(Message):
    """A joystick's deflections, 0 for an axis that is not named.

    The speeds reached depend on the gimbal's own joystick settings.
    """

    controller: ClassVar[byte] = 0x01
    pitch: stick
    roll: stick
    yaw: stick

    @classmethod
    def completed(cls, fields: Mapping[str, Any]) -> Mapping[str, Any]:
        return resting(fields)


@message("gimbal.dial", GIMBAL, 0x0A, cmd_type=STREAM)
class Dial(Message):
    """A dial's speed; what it controls is set on the gimbal."""

    controller: ClassVar[byte] = 0x02
    speed: Annotated[int, I16(low=-2048, high=2048)]


@message("gimbal.parameters", GIMBAL, 0x0B)
class Parameters(Message):
    """Ask for user parameters by id."""

    ids: Annotated[tuple[int, ...], Ids(ParameterId)]


@message("gimbal.parameters", GIMBAL, 0x0B, reply=True)
class ParametersReply(Message):
    """The user parameters asked for."""

    return_code: result_code
    parameters: tlv


@message("gimbal.set_parameters", GIMBAL, 0x0C)
class SetParameters(Message):
    """Set user parameters. `motor:01` lets the motors sleep, `motor:00` wakes them."""

    parameters: tlv


@message("gimbal.set_parameters", GIMBAL, 0x0C, reply=True)
class SetParametersReply(Message):
    """The user parameters as they are now."""

    return_code: result_code
    parameters: tlv


@message("gimbal.orientation", GIMBAL, 0x0D)
class Orient(Message):
    """Switch between landscape and portrait."""

    mode: Annotated[int, U8(low=0xFE, high=0xFE)] = field(default=0xFE, kw_only=True)
    orientation: Annotated[int, U8(words=Orientation)]


@message("gimbal.mode", GIMBAL, 0x0E)
class Mode(Message):
    """Follow in `mode`, or, with the mode UNCHANGED, recenter or turn to selfie once."""

    mode: Annotated[int, U8(words=FollowMode)] = FollowMode.UNCHANGED
    action: Annotated[int, U8(words=CenterAction)] = CenterAction.NONE

    def check(self) -> None:
        Message.check(self)
        if (self.mode == FollowMode.UNCHANGED) == (self.action == CenterAction.NONE):
            raise FieldError(f"{self.name}: give either a mode (lock, yaw, sport) or an action (recenter, selfie)")


@message("gimbal.calibrate", GIMBAL, 0x0F)
class Calibrate(Message):
    """Start or stop the automatic tuning. Type 1 is what the document asks for; type 0 has been seen to work."""

    parameter: ClassVar[byte] = 0x00
    length: ClassVar[byte] = 1
    start: Annotated[bool, Flag(first=0)] = True
    type: Annotated[int, Bits(first=1, width=7, low=0, high=1)] = 1


@message("gimbal.calibration", GIMBAL, 0x10, reply=None, cmd_type=STREAM)
class Calibration(Message):
    """How the automatic tuning goes."""

    parameter: ClassVar[byte] = 0x00
    length: ClassVar[byte] = 6
    state: Annotated[int, U8(words=CalibrationState)]
    progress: percent
    error: Annotated[int, U32()] = 0


@message("gimbal.track", GIMBAL, 0x11)
class ActiveTrack(Message):
    """Start tracking, or stop it: the gimbal does not say which."""

    track: Annotated[int, U8(words=Track)] = Track.TOGGLE
