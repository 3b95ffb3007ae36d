"""Frames as some real gimbals send them: docs/protocol-facts.md, 0E 02 and 0E 08."""

from __future__ import annotations

import struct

import pytest
from raw_frames import raw_frame

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind, CalibrationState
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware, Order
from teleop.sim.gimbal.quirks import legacy_angles, pushed

PUSH = gimbal.Push(True, True, True, 10, -20, 30, 1, 2, 3, 145, 55, 179, 179, 30, 30, 50, 50, 50)
FRAME = raw_frame(PUSH.data(), 0, 0x1234)


@pytest.mark.parametrize(("order", "tenths"), [("yaw-roll-pitch", (100, -5, 31)), ("yaw-pitch-roll", (100, 31, -5))])
def test_old_angles_have_no_type_and_one_of_two_orders(order: Order, tenths: tuple[int, int, int]) -> None:
    reply = gimbal.AnglesReply(0, AngleKind.ATTITUDE, 10.0, -0.5, 3.1)
    data = legacy_angles(reply, order).data()
    assert data == b"\0" + struct.pack("<3h", *tenths)
    assert len(raw_frame(data)) == 23


def test_the_documents_firmware_changes_no_frame() -> None:
    assert pushed(FRAME, PUSH, DOCUMENTED) == FRAME


def test_a_push_may_have_the_reply_bit_and_the_same_data() -> None:
    assert pushed(FRAME, PUSH, Firmware(push_reply_bit=True)) == raw_frame(PUSH.data(), 0x20, 0x1234)


def test_a_short_push_is_a_frame_of_25_bytes_with_flags_and_angles() -> None:
    short = pushed(FRAME, PUSH, Firmware(short_push=True))
    assert len(short) == 25
    assert short == raw_frame(b"\x0e\x08\x07" + struct.pack("<3h", 100, -200, 300), 0, 0x1234)


def test_only_the_push_of_angles_is_cut() -> None:
    progress = gimbal.Calibration(CalibrationState.RUNNING, 40)
    frame = raw_frame(progress.data(), 0, 5)
    assert pushed(frame, progress, Firmware(short_push=True)) == frame
