"""Serial numbers are blanked in a capture, with right checks, and everything else is as it was heard."""

from __future__ import annotations

import math
from itertools import chain

from hypothesis import given, settings
from hypothesis import strategies as st
from made_captures import CAN0, STARTED, MadeCapture

from teleop.captures.captured import FROM_DEVICE, TO_DEVICE, Captured, Source
from teleop.captures.serial_numbers import SerialNumbers
from teleop.dji.drone import messages as drone
from teleop.dji.frame import REPLY, Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.links.can import GIMBAL_ID

NUMBER = b"0M6CH7R0A1B2C3"
ANGLES = gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 1.5, 0.0, -2.0)


def blanked(frames: list[Captured], source: Source = CAN0) -> tuple[list[Captured], int]:
    numbers = SerialNumbers(source)
    out = []
    for frame in frames:
        numbers.add(frame)
        out += numbers.settled(frame.time)
    return [*out, *numbers.settled(math.inf)], numbers.blanked


def frames_from(captured: list[Captured], sender: int) -> list[Frame]:
    reader = FrameReader(in_pieces=sender == GIMBAL_ID)
    data = b"".join(each.data for each in captured if each.id == sender)
    found = [*reader.feed(data, 0.0), *reader.flush(math.inf)]
    assert all(isinstance(each, Frame) for each in found)
    return [each for each in found if isinstance(each, Frame)]


def version(extra: bytes) -> gimbal.VersionReply:
    return gimbal.VersionReply(0, 1, "02.02.00.07", extra=extra)


def test_a_number_behind_the_version_is_zeros_in_a_good_frame() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 1)
    made.answer(0.005, version(NUMBER), 1)
    made.answer(0.01, ANGLES, 2)
    out, count = blanked(made.frames)
    assert count == 1
    first, second = frames_from(out, GIMBAL_ID)
    assert first.data == version(bytes(len(NUMBER))).data()
    assert second.data == ANGLES.data()
    assert [(each.time, each.id, len(each.data)) for each in out] == [
        (each.time, each.id, len(each.data)) for each in made.frames
    ]


def test_old_firmware_and_unknown_replies_too() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 1)
    made.answer(0.005, version(NUMBER), 1, bare=version(NUMBER).encode())
    made.send(0.01, GIMBAL_ID, Frame(b"\x0e\x77\x00" + NUMBER + b"\x01\x02", REPLY, 9).encode())
    out, count = blanked(made.frames)
    assert count == 2
    bare, unknown = frames_from(out, GIMBAL_ID)
    assert bare.data == version(bytes(len(NUMBER))).encode()
    assert unknown.data == b"\x0e\x77\x00" + bytes(len(NUMBER)) + b"\x01\x02"


def test_a_drone_keeps_its_version_and_loses_its_id_app_and_bundle() -> None:
    reply = drone.VersionAck(0xFF01, 7, "041D492163", "SDK-v1.0 BETA M100-03.01.01.00")
    frames = [
        Captured(STARTED, TO_DEVICE, Frame(drone.Activate(1030093, bundle="my.bundle").data(), 2, 1).encode()),
        Captured(STARTED + 0.1, FROM_DEVICE, Frame(reply.encode(), REPLY, 1).encode()),
    ]
    out, count = blanked(frames, Source("serial", "ttyUSB0", "drone"))
    assert count == 2
    [asked] = frames_from(out, TO_DEVICE)
    [answered] = frames_from(out, FROM_DEVICE)
    assert b"my.bundle" not in asked.data
    assert drone.Activate.decode(asked.data[2:]).fields()["app_id"] == 0
    assert drone.VersionAck.decode(answered.data) == drone.VersionAck(0xFF01, 7, "", reply.version)


@given(st.lists(st.integers(0, 5), max_size=12), st.randoms(use_true_random=False))
@settings(max_examples=15, deadline=None)
def test_what_has_no_number_comes_out_as_it_went_in(kinds: list[int], random) -> None:
    made = MadeCapture()
    for number, kind in enumerate(kinds):
        time = number * 0.01
        match kind:
            case 0:
                made.ask(time, gimbal.Version(), number)
            case 1:
                made.answer(time, version(b""), number)
            case 2:
                made.answer(time, ANGLES, number)
            case 3:
                made.send(time, 0x530, random.randbytes(8))
            case 4:
                made.send(time, GIMBAL_ID, random.randbytes(random.randrange(20)))  # damage
            case _:
                made.frames.append(Captured(STARTED + time, GIMBAL_ID, b"", error=True))
    out, count = blanked(made.frames)
    assert (out, count) == (made.frames, 0)


def test_nothing_is_held_back_for_long() -> None:
    made = MadeCapture()
    made.answer(0.0, ANGLES, 1)
    numbers = SerialNumbers(CAN0)
    numbers.add(made.frames[0])  # the rest never comes
    assert list(numbers.settled(STARTED + 0.05)) == []
    assert list(numbers.settled(STARTED + 0.11)) == made.frames[:1]
    foreign = Captured(STARTED + 0.2, 0x530, b"x")
    numbers.add(foreign)
    assert list(chain(numbers.settled(STARTED + 0.2))) == [foreign]
