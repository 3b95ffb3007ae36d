"""Frames of real gimbals that differ from the document's: old replies, and pushes of some firmware."""

from __future__ import annotations

import struct
from dataclasses import replace
from typing import Final

from teleop.config.wiring import AngleOrder
from teleop.dji.frame import REPLY, Frame
from teleop.dji.gimbal import focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message, Opaque
from teleop.sim.gimbal.firmware import Firmware

_SHORT: Final = 9  # bytes: set, id, flags, yaw, roll, pitch, which make a frame of 25


def replied(message: Message, firmware: Firmware, bare: bool) -> Message:
    """A reply as this firmware sends it; `bare` is one that will be without set and id."""
    if not isinstance(message, gimbal.AnglesReply):
        return message
    if firmware.legacy_replies:
        return legacy_angles(message, firmware.legacy_order)
    exchanged = firmware.legacy_order == "all-yaw-pitch-roll" or (bare and firmware.legacy_order == "yaw-pitch-roll")
    return replace(message, roll=message.pitch, pitch=message.roll) if exchanged else message


def legacy_angles(reply: gimbal.AnglesReply, order: AngleOrder) -> Message:
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


def has_no_reply(message: Message) -> bool:
    """Whether no reply belongs to it, well formed or not, whatever its CmdType asks (V2.5, figures 17, 21, 22, 32)."""
    data = message.data()
    if data[:2] == gimbal.Version.set_and_id:
        return isinstance(message, gimbal.VersionPush)
    return data[:2] == gimbal.Joystick.set_and_id or data[:3] == focus.Set.set_and_id + b"\x01"
