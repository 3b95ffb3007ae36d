"""Frames of real gimbals that differ from the document's: old replies, and pushes of some firmware."""

from __future__ import annotations

import struct
from typing import Final

from teleop.dji.frame import REPLY, Frame
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message, Opaque
from teleop.sim.gimbal.firmware import Firmware, Order

_SHORT: Final = 9  # bytes: set, id, flags, yaw, roll, pitch, which make a frame of 25


def legacy_angles(reply: gimbal.AnglesReply, order: Order) -> Message:
    """The angles without their type, in the order that one source or the others have seen."""
    angles = {"yaw": reply.yaw, "roll": reply.roll, "pitch": reply.pitch}
    tenths = (round(10 * angles[axis]) for axis in order.removeprefix("all-").split("-"))
    return Opaque(b"", struct.pack("<B3h", reply.return_code, *tenths))


def pushed(frame: bytes, push: Message, firmware: Firmware) -> bytes:
    """A push as this firmware sends it."""
    if not (firmware.push_reply_bit or firmware.short_push):
        return frame
    data = push.data()
    if firmware.short_push and isinstance(push, gimbal.Push):
        data = data[:_SHORT]
    sequence = int.from_bytes(frame[8:10], "little")
    return Frame(data, REPLY if firmware.push_reply_bit else frame[3], sequence).encode()
