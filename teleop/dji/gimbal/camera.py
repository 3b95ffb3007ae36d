"""Command set 0x0D: the camera that a gimbal controls, by cable or wireless (V2.5 section 2.3.5)."""

from __future__ import annotations

from enum import IntEnum
from typing import Annotated, Final

from teleop.dji.fields import U8, U16
from teleop.dji.message import Message, message, result_code

CAMERA: Final = 0x0D  # command set, section 2.3.1


class CameraCommand(IntEnum):
    """The commands of a camera; photo and focus commands hold until their STOP."""

    SHUTTER = 0x0001
    STOP_SHUTTER = 0x0002
    RECORD = 0x0003
    STOP = 0x0004
    CENTER_FOCUS = 0x0005
    END_CENTER_FOCUS = 0x000B


class Query(IntEnum):
    """What the camera can be asked."""

    RECORDING = 0x01


class CameraState(IntEnum):
    """What the camera does."""

    IDLE = 0x00
    RECORDING = 0x02


@message("camera.command", CAMERA, 0x00)
class Command(Message):
    """Photo, record and focus."""

    command: Annotated[int, U16(words=CameraCommand)]


@message("camera.short_command", CAMERA, 0x00)
class ShortCommand(Message):
    """Command in a single byte, as DJI's own demo software sends it against its document."""

    command: Annotated[int, U8(words=CameraCommand)]


@message("camera.status", CAMERA, 0x01)
class Status(Message):
    """Ask whether the camera records."""

    query: Annotated[int, U8(words=Query)] = Query.RECORDING


@message("camera.status", CAMERA, 0x01, reply=True)
class StatusReply(Message):
    """Whether the camera records."""

    return_code: result_code
    state: Annotated[int, U8(words=CameraState)]
