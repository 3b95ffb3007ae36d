"""Two sessions talk to each other through bytes; time is whatever the test says."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal import focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Lost, Received, Session
from teleop.dji.message import FieldError, Message, Opaque, Result, ReturnCode

POSITION = gimbal.Position(1.0, 2.0, 3.0)
PUSH = gimbal.Push(True, True, True, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 145, 55, 179, 179, 30, 30, 46, 54, 65)
ANGLES = gimbal.AnglesReply(ReturnCode.OK, gimbal.AngleKind.ATTITUDE, 1.0, 2.0, 3.0)


def frame_of(data: bytes) -> Frame:
    (frame,) = FrameReader().feed(data, 0.0)
    assert isinstance(frame, Frame)
    return frame


def answer(request: bytes, message: Message, bare: bool = False) -> bytes:
    return Session().reply(frame_of(request), message, bare)


def test_commands_are_numbered_and_the_numbers_wrap() -> None:
    session = Session(first_sequence=0xFFFE)
    frames = [frame_of(session.command(message)) for message in (POSITION, gimbal.Joystick(0, 0, 0), gimbal.Limits())]
    assert [frame.sequence for frame in frames] == [0xFFFE, 0xFFFF, 0]
    assert [frame.cmd_type for frame in frames] == [0x03, 0x00, 0x03]
    assert frames[0].data == POSITION.data()
    assert session.counts.frames_out == 3


def test_a_message_out_of_range_is_refused_and_takes_no_number() -> None:
    session = Session()
    for send in (session.command, lambda message: session.request(message, 0.0)):
        with pytest.raises(FieldError, match=r"gimbal.position: yaw must be -180..180 deg, not 200"):
            send(gimbal.Position(200, 0, 0))
    assert frame_of(session.command(POSITION)).sequence == 0
    assert session.overdue(1e9) == []


@pytest.mark.parametrize("bare", [False, True])
@given(order=st.permutations(range(4)))
def test_replies_find_their_requests_in_any_order(bare: bool, order: list[int]) -> None:
    session = Session(first_sequence=0xFFFE)
    requests = [POSITION, gimbal.Angles(), gimbal.Speed(0, 0, 0), gimbal.Angles()]
    replies = [Result(ReturnCode.FAILED), ANGLES, Result(), ANGLES]
    sent = [session.request(message, 0.0)[0] for message in requests]
    for index in order:
        (received,) = session.receive(answer(sent[index], replies[index], bare), 0.05)
        assert received.message == replies[index]
        assert received.request == requests[index]
    assert session.overdue(1.0) == []
    assert session.counts.replies == 4


def test_a_reply_that_fails_may_be_a_return_code_alone() -> None:
    session = Session()
    request, _ = session.request(gimbal.Limits(), 0.0)
    (received,) = session.receive(answer(request, Result(ReturnCode.FAILED)), 0.0)
    assert (received.message, received.request) == (Result(ReturnCode.FAILED), gimbal.Limits())


def test_requests_are_lost_when_their_time_is_over_and_only_once() -> None:
    session = Session()
    _, first = session.request(POSITION, 10.0)
    request, second = session.request(gimbal.Angles(), 10.05, timeout=0.2)
    assert session.overdue(10.1) == []
    assert session.overdue(10.11) == [Lost(POSITION, first, 10.0)]
    assert session.overdue(10.11) == []
    assert session.overdue(11.0) == [Lost(gimbal.Angles(), second, 10.05)]
    assert session.counts.lost_replies == 2
    (late,) = session.receive(answer(request, ANGLES), 11.0)
    assert late == Received(ANGLES, late.frame)
    assert session.counts.unmatched_replies == 1


def test_a_second_reply_answers_nothing() -> None:
    session = Session()
    request, _ = session.request(POSITION, 0.0)
    first, second = session.receive(answer(request, Result()) * 2, 0.0)
    assert (first.request, second.request) == (POSITION, None)
    assert (session.counts.replies, session.counts.unmatched_replies) == (1, 1)


def test_what_was_commanded_without_asking_is_answered_to_nobody() -> None:
    session = Session()
    (received,) = session.receive(answer(session.command(POSITION), Result()), 0.0)
    assert received.request is None
    assert session.overdue(1.0) == []
    assert session.counts.unmatched_replies == 1


@pytest.mark.parametrize("cmd_type", [0x00, 0x03, 0x20])
def test_a_push_with_an_open_requests_number_is_not_its_reply(cmd_type: int) -> None:
    session = Session()
    request, sequence = session.request(gimbal.Angles(), 0.0)
    (received,) = session.receive(Frame(PUSH.data(), cmd_type, sequence).encode(), 0.0)
    assert (received.message, received.request) == (PUSH, None)
    assert session.counts.unmatched_replies == 0
    (received,) = session.receive(answer(request, ANGLES), 0.0)
    assert received.request == gimbal.Angles()


def test_a_reply_to_another_command_with_the_same_number_is_not_taken() -> None:
    session = Session()
    _, sequence = session.request(gimbal.Angles(), 0.0)
    (received,) = session.receive(Frame(b"\x0e\x00\x00", 0x20, sequence).encode(), 0.0)
    assert (received.message, received.request) == (Result(), None)
    assert len(session.overdue(1.0)) == 1


def test_damage_and_what_is_unknown_are_counted() -> None:
    session = Session()
    good = Frame(PUSH.data()).encode()
    unknown = Frame(b"\x0e\x77\x01", 0x00).encode()
    received = session.receive(good[:20] + good + unknown, 0.0)
    assert [item.message for item in received] == [PUSH, Opaque(b"\x0e\x77", b"\x01")]
    assert (session.counts.damage, session.counts.unknown, session.counts.frames_in) == (1, 1, 2)


def test_a_number_used_again_while_open_is_a_lost_reply() -> None:
    session = Session()
    session.request(POSITION, 0.0)
    for _ in range(0xFFFF):
        session.command(gimbal.Dial(0))
    session.request(gimbal.Angles(), 0.0)
    assert session.counts.lost_replies == 1
    assert [lost.request for lost in session.overdue(1.0)] == [gimbal.Angles()]


def test_both_ends_are_sessions() -> None:
    host, device = Session(), Session()
    request, sequence = host.request(gimbal.Limits(), 0.0)
    (asked,) = device.receive(request, 0.0)
    assert asked.message == gimbal.Limits()
    assert asked.frame.wants_reply
    limits = gimbal.LimitsReply(ReturnCode.OK, 155, 55, 179, 179, 30, 30)
    reply = device.reply(asked.frame, limits)
    assert (frame_of(reply).sequence, frame_of(reply).cmd_type) == (sequence, 0x20)
    assert [item.message for item in host.receive(reply + device.command(PUSH), 0.0)] == [limits, PUSH]
    assert device.counts.frames_out == 2


@given(st.lists(st.binary(max_size=40) | st.binary(max_size=30).map(lambda data: Frame(data, 0x20).encode())))
def test_receiving_never_raises(parts: list[bytes]) -> None:
    session = Session()
    session.request(gimbal.Angles(), 0.0)
    for number, part in enumerate(parts):
        session.receive(part, number * 0.07)


@pytest.mark.parametrize(
    "message", [gimbal.Joystick(1, 2, 3), gimbal.Dial(5), gimbal.VersionPush("01.02.03.04"), focus.Set(100)]
)
def test_what_has_no_reply_can_lose_none(message: Message) -> None:
    session = Session()
    frame, sequence = session.request(message, 0.0)
    assert frame_of(frame).sequence == sequence == 0
    assert session.overdue(10.0) == []
    assert session.counts.lost_replies == 0


@pytest.mark.parametrize("value", ["", "01", "01 0a00 1400 1e00", "07" + "00" * 21, "07" + "00" * 40])
def test_a_push_with_the_reply_bit_is_no_reply_whatever_its_length_and_number(value: str) -> None:
    """Not even when its number is that of an open request."""
    session = Session()
    session.request(gimbal.Angles(), 0.0)
    pushed = Frame(b"\x0e\x08" + bytes.fromhex(value), 0x20, 0).encode()
    (received,) = session.receive(pushed, 0.0)
    assert received.request is None
    assert not isinstance(received.message, Result)
    assert session.counts.unmatched_replies == 0
    assert len(session.overdue(1.0)) == 1


@pytest.mark.parametrize("kind", ["01", ""])
def test_angles_of_old_firmware_say_that_they_are_bare(kind: str) -> None:
    session = Session()
    session.request(gimbal.Angles(), 0.0)
    (received,) = session.receive(Frame(bytes.fromhex(f"00 {kind} 0a00 1400 1e00"), 0x20, 0).encode(), 0.0)
    assert isinstance(received.message, gimbal.AnglesReply if kind else gimbal.LegacyAnglesReply)
    assert (received.message.yaw, received.message.roll, received.message.pitch) == (1.0, 2.0, 3.0)
    assert received.bare
    assert received.request == gimbal.Angles()
