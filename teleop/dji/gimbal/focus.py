"""The focus motor: command 0x12 of set 0x0E, whose first byte (in replies, the second) says which of three it is.

V2.5 section 2.3.4.19. A motor that is not calibrated ignores positions.
"""

from __future__ import annotations

from dataclasses import field
from enum import IntEnum
from typing import Annotated, ClassVar

from teleop.dji.fields import U8, U16, U32
from teleop.dji.gimbal.messages import GIMBAL, byte
from teleop.dji.message import STREAM, Message, message, result_code

FOCUS_MOTOR = 0x00  # the only kind of motor and of control the document has

motor_type = Annotated[int, U8(low=FOCUS_MOTOR, high=FOCUS_MOTOR)]


class CalibrationAction(IntEnum):
    """By hand: turn to one end, MINIMUM, turn to the other, MAXIMUM, then MANUAL."""

    NONE = 0
    AUTO = 1
    MANUAL = 2
    MINIMUM = 4
    MAXIMUM = 5
    STOP = 6


class Execution(IntEnum):
    """What became of a calibration command."""

    SUCCEEDED = 0
    FAILED = 1


class EndpointState(IntEnum):
    """Whether the motor knows the ends of the lens."""

    UNCALIBRATED = 1
    CALIBRATING = 2
    CALIBRATED = 3


@message("focus.set", GIMBAL, 0x12, cmd_type=STREAM)
class Set(Message):
    """Turn the focus motor to `position`; at most 100 times a second, never answered."""

    sub_id: ClassVar[byte] = 0x01
    control: motor_type = field(default=FOCUS_MOTOR, kw_only=True)
    length: ClassVar[byte] = 2
    position: Annotated[int, U16(low=0, high=4095)]


@message("focus.calibrate", GIMBAL, 0x12)
class Calibrate(Message):
    """Find the ends of the lens."""

    sub_id: ClassVar[byte] = 0x02
    motor: motor_type = field(default=FOCUS_MOTOR, kw_only=True)
    action: Annotated[int, U8(words=CalibrationAction)]


@message("focus.calibrate", GIMBAL, 0x12, reply=True)
class CalibrateReply(Message):
    """Whether the calibration command was carried out."""

    return_code: result_code
    sub_id: ClassVar[byte] = 0x02
    motor: motor_type
    execution: Annotated[int, U8(words=Execution)]


@message("focus.get", GIMBAL, 0x12)
class Get(Message):
    """Ask where the focus motor is."""

    sub_id: ClassVar[byte] = 0x15
    motor: motor_type = FOCUS_MOTOR


@message("focus.get", GIMBAL, 0x12, reply=True)
class GetReply(Message):
    """Where the focus motor is."""

    return_code: result_code
    sub_id: ClassVar[byte] = 0x15
    motor: motor_type
    calibration: Annotated[int, U8(words=EndpointState)]
    position: Annotated[int, U32(low=0, high=4095)]
