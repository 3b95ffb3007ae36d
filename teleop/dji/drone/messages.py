"""The drone's commands and queries over the Onboard SDK, and its acknowledgements: sets 00 and 01, and the push 02 01.

Values are those of docs/protocol-facts.md. An acknowledgement has no set and id: its class says which command it
answers, and the session finds out which that was. Its fields are as wide as the facts say: u16 codes; arming is not
said to have one, so that a single byte is taken too. Movement is in movement.py, the virtual RC in virtual_rc.py,
what the drone says of itself in broadcast.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Any, ClassVar, Final

from teleop.dji.drone.enums import (
    ActivationCode,
    ArmCode,
    ArmOrder,
    Code,
    ControlCode,
    ControlOrder,
    Event,
    Rate,
    ShortArmCode,
    TaskCode,
    TaskKind,
    TaskResultCode,
)
from teleop.dji.fields import I16, U8, U16, U32, Flag, Reserved
from teleop.dji.float_fields import Text
from teleop.dji.gimbal.unnamed_axes import ignoring, resting
from teleop.dji.message import STREAM, Message, message

ACTIVATION: Final = 0x00  # command sets
CONTROL: Final = 0x01
PUSH: Final = 0x02

ACKNOWLEDGED: Final = 2  # the session of a command that must be acknowledged; the sender picks another up to 31

LEVEL: Final = 2
M100_VERSION: Final = 0x03010A00
NOBODY: Final = "9" * 32  # what DJI's own software sends where an iOS app would have its name

zero = Annotated[int, U8()]
decidegrees = Annotated[float, I16(scale=10, unit="deg")]
decidegrees_per_second = Annotated[float, I16(scale=10, unit="deg/s", low=-180, high=180)]
rate = Annotated[int, U8(words=Rate)]
code = Annotated[int, U16(words=Code)]


@message("drone.version", ACTIVATION, 0x00, cmd_type=ACKNOWLEDGED)
class Version(Message):
    """Ask for the drone's version, which it tells before activation too."""

    value: ClassVar[zero] = 0


@message("drone.version", ACTIVATION, 0x00, reply=True)
class VersionAck(Message):
    """The drone's version; the code also says whether it is activated.

    A Matrice 100 answers 0xFF01, 0xA6453AAC, `041D492163`, `SDK-v1.0 BETA M100-03.01.01.00`: code, CRC, serial number,
    name (docs/protocol-facts.md).
    """

    code: code
    checksum: Annotated[int, U32()]
    id: Annotated[str, Text("11s")]
    version: Annotated[str, Text("32s")]


@message("drone.short_version", ACTIVATION, 0x00, reply=True)
class ShortVersionAck(Message):
    """VersionAck without the serial number, as OPENProtocol.md 3.1.9 has it."""

    code: code
    checksum: Annotated[int, U32()]
    version: Annotated[str, Text("32s")]


@message("drone.activate", ACTIVATION, 0x01, cmd_type=ACKNOWLEDGED)
class Activate(Message):
    """Say which app this is; nothing else is obeyed before. The id is a secret: it is not in the repr."""

    app_id: Annotated[int, U32()] = field(repr=False)
    level: Annotated[int, U32()] = LEVEL
    version: Annotated[int, U32()] = M100_VERSION
    bundle: Annotated[str, Text("32s")] = NOBODY


@message("drone.activate", ACTIVATION, 0x01, reply=True)
class ActivateAck(Message):
    """What became of the activation."""

    code: Annotated[int, U16(words=ActivationCode)]


@message("drone.frequency", ACTIVATION, 0x10, cmd_type=ACKNOWLEDGED)
class Frequency(Message):
    """How often the M100 sends each part of the broadcast. The virtual-RC bit is in `control`, off unless asked for."""

    time: rate = Rate.HOLD
    quaternion: rate = Rate.HOLD
    acceleration: rate = Rate.HOLD
    velocity: rate = Rate.HOLD
    angular_rate: rate = Rate.HOLD
    position: rate = Rate.HOLD
    magnetometer: rate = Rate.HOLD
    rc: rate = Rate.HOLD
    gimbal: rate = Rate.HOLD
    status: rate = Rate.HOLD
    battery: rate = Rate.HOLD
    control: rate = Rate.HOLD
    reserved: Annotated[int, U32(low=0, high=0)] = 0


@message("drone.frequency", ACTIVATION, 0x10, cmd_type=ACKNOWLEDGED)
class A3Frequency(Message):
    """How often the A3 and the M600 send each part of the broadcast."""

    time: rate = Rate.HOLD
    quaternion: rate = Rate.HOLD
    acceleration: rate = Rate.HOLD
    velocity: rate = Rate.HOLD
    angular_rate: rate = Rate.HOLD
    position: rate = Rate.HOLD
    gps: rate = Rate.HOLD
    rtk: rate = Rate.HOLD
    magnetometer: rate = Rate.HOLD
    rc: rate = Rate.HOLD
    gimbal: rate = Rate.HOLD
    status: rate = Rate.HOLD
    battery: rate = Rate.HOLD
    control: rate = Rate.HOLD
    reserved: Annotated[int, U16(low=0, high=0)] = 0


@message("drone.frequency", ACTIVATION, 0x10, reply=True)
class FrequencyAck(Message):
    """Whether the rates were taken."""

    code: code


@message("drone.control", CONTROL, 0x00, cmd_type=ACKNOWLEDGED)
class Control(Message):
    """Obtain or release control of the movement, which the drone gives in F mode only; the virtual RC needs none."""

    order: Annotated[int, U8(words=ControlOrder)]


@message("drone.control", CONTROL, 0x00, reply=True)
class ControlAck(Message):
    """Who has control now."""

    code: Annotated[int, U16(words=ControlCode)]


@message("drone.task", CONTROL, 0x01, cmd_type=ACKNOWLEDGED)
class Task(Message):
    """Take off, land, or return home; `number` counts the tasks."""

    number: Annotated[int, U8()] = field(default=0, kw_only=True)
    task: Annotated[int, U8(words=TaskKind)]


@message("drone.task", CONTROL, 0x01, reply=True)
class TaskAck(Message):
    """Whether the task has started; how it ends is in the broadcast's status."""

    code: Annotated[int, U16(words=TaskCode)]


@message("drone.task_result", CONTROL, 0x02, cmd_type=ACKNOWLEDGED)
class TaskResult(Message):
    """Ask how the task of this `number` went: "Request Switch Result" in OPENProtocol.md 3.1.9."""

    number: Annotated[int, U8()] = 0


@message("drone.task_result", CONTROL, 0x02, reply=True)
class TaskResultAck(Message):
    """How the task went."""

    code: Annotated[int, U16(words=TaskResultCode)]


@message("drone.arm", CONTROL, 0x05, cmd_type=ACKNOWLEDGED)
class Arm(Message):
    """Start or stop the motors."""

    order: Annotated[int, U8(words=ArmOrder)]


@message("drone.arm", CONTROL, 0x05, reply=True)
class ArmAck(Message):
    """What became of arming."""

    code: Annotated[int, U16(words=ArmCode)]


@message("drone.short_arm", CONTROL, 0x05, reply=True)
class ShortArmAck(Message):
    """ArmAck in a single byte."""

    code: Annotated[int, U8(words=ShortArmCode)]


@message("drone.gimbal_speed", CONTROL, 0x1A, cmd_type=STREAM)
class GimbalSpeed(Message):
    """Turn the drone's gimbal at these speeds; an axis that is not named gets 0."""

    yaw: decidegrees_per_second
    roll: decidegrees_per_second
    pitch: decidegrees_per_second
    control: Annotated[bool, Flag(first=7)] = True
    reserved: Annotated[int, Reserved()] = 0

    @classmethod
    def completed(cls, fields: Mapping[str, Any]) -> Mapping[str, Any]:
        return resting(fields)


@message("drone.gimbal_angle", CONTROL, 0x1B, cmd_type=STREAM)
class GimbalAngle(Message):
    """Turn the drone's gimbal to these angles, or by them when not `absolute`, within `duration`.

    An axis that is not named is ignored.
    """

    yaw: decidegrees
    roll: decidegrees
    pitch: decidegrees
    absolute: Annotated[bool, Flag(first=0)] = True
    yaw_ignored: Annotated[bool, Flag(first=1)] = False
    roll_ignored: Annotated[bool, Flag(first=2)] = False
    pitch_ignored: Annotated[bool, Flag(first=3)] = False
    reserved: Annotated[int, Reserved()] = 0
    duration: Annotated[float, U8(scale=10, unit="s", low=0.1, high=25.5)] = field(kw_only=True)

    @classmethod
    def completed(cls, fields: Mapping[str, Any]) -> Mapping[str, Any]:
        return ignoring(fields)


@message("drone.photo", CONTROL, 0x20, cmd_type=STREAM)
class Photo(Message):
    """Take a photo."""

    value: ClassVar[zero] = 0


@message("drone.start_video", CONTROL, 0x21, cmd_type=STREAM)
class StartVideo(Message):
    """Start recording."""

    value: ClassVar[zero] = 0


@message("drone.stop_video", CONTROL, 0x22, cmd_type=STREAM)
class StopVideo(Message):
    """Stop recording."""

    value: ClassVar[zero] = 0


@message("drone.event", PUSH, 0x01, cmd_type=ACKNOWLEDGED)
class Pushed(Message):
    """The drone says that the onboard computer has lost control."""

    event: Annotated[int, U8(words=Event)] = Event.CONTROL_LOST


@message("drone.event", PUSH, 0x01, reply=True)
class PushedAck(Message):
    """The onboard computer has received it."""

    code: code = Code.OK
