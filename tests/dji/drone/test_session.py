"""Two ends of the drone's link talk through bytes; time is whatever the test says."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.drone import messages as drone
from teleop.dji.drone import virtual_rc
from teleop.dji.drone.broadcast import Broadcast
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.enums import ArmOrder, Code, ControlCode, ControlOrder, TaskCode, TaskKind
from teleop.dji.drone.session import OWN, SENDS, BusyError, OnboardSession
from teleop.dji.frame import Frame, FrameReader
from teleop.dji.message import FieldError, Message, Opaque

VECTORS = {
    vector["name"]: vector
    for vector in json.loads((Path(__file__).parents[2] / "data" / "onboard.json").read_text())["vectors"]
}
OBTAIN = drone.Control(ControlOrder.OBTAIN)
OBTAINED = drone.ControlAck(ControlCode.OBTAINED)
TAKE_OFF = drone.Task(TaskKind.TAKE_OFF)
MADE: dict[str, Message] = {
    "get_version": drone.Version(),
    "activate": drone.Activate(1030093),
    "set_control_obtain": OBTAIN,
}


def frame_of(data: bytes) -> Frame:
    (frame,) = FrameReader().feed(data, 0.0)
    assert isinstance(frame, Frame)
    return frame


def answer(request: bytes, message: Message) -> bytes:
    return OnboardSession().reply(frame_of(request), message)


@pytest.mark.parametrize("name", MADE)
def test_requests_are_the_published_frames_and_are_sent_as_often(name: str) -> None:
    vector = VECTORS[name]
    session = OnboardSession(first_sequence=vector["seq"])
    frame, _ = session.request(MADE[name], 0.0)
    assert frame.hex() == vector["hex"]
    assert SENDS[type(MADE[name])] == (vector["timeout_ms"] / 1000, vector["sends"])


@pytest.mark.parametrize(
    ("message", "times"),
    [
        (drone.Version(), [0.0, 0.1, 0.2]),
        (drone.Activate(1), [0.0, 1.0, 2.0]),
        (drone.Frequency(), [0.0]),
        (OBTAIN, [0.0, 0.5]),
        (TAKE_OFF, [0.0, 0.1, 0.2]),
        (drone.Arm(ArmOrder.ARM), [0.0]),
    ],
)
def test_a_request_without_an_answer_is_sent_again_byte_for_byte_and_then_given_up(
    message: Message, times: list[float]
) -> None:
    session = OnboardSession()
    frame, sequence = session.request(message, 0.0)
    sent, lost = [0.0], {}
    for tick in range(1, 400):
        now = tick / 100
        for again in session.due(now):
            assert again == frame
            sent.append(now)
        for each in session.overdue(now):
            lost[now] = each
    assert sent == pytest.approx(times, abs=0.03)
    ((when, given_up),) = lost.items()
    assert (given_up.request, given_up.sequence, given_up.sent) == (message, sequence, 0.0)
    assert when == pytest.approx(SENDS.get(type(message), (0.1, 1))[0] * len(times), abs=0.02)
    assert (session.counts.sent_again, session.counts.lost_replies) == (len(times) - 1, 1)


def test_nothing_is_sent_again_after_a_stall() -> None:
    session = OnboardSession()
    session.request(TAKE_OFF, 0.0)
    assert session.due(1.5) == []
    assert [lost.request for lost in session.overdue(1.5)] == [TAKE_OFF]


def test_nothing_is_sent_again_after_a_newer_order_of_its_kind() -> None:
    session = OnboardSession()
    session.request(TAKE_OFF, 0.0)
    landing, _ = session.request(drone.Task(TaskKind.LAND, number=1), 0.05)
    assert session.due(0.11) == []
    assert session.due(0.16) == [landing]


def test_what_is_withdrawn_is_not_sent_again_and_can_still_be_answered() -> None:
    session = OnboardSession()
    obtain, _ = session.request(OBTAIN, 0.0)
    version, _ = session.request(drone.Version(), 0.45)
    session.withdraw(drone.Control, drone.Task)
    assert session.due(0.56) == [version]
    [received] = session.receive(answer(obtain, OBTAINED), 0.6)
    assert (received.message, received.request) == (OBTAINED, OBTAIN)


def test_each_open_request_has_a_session_of_its_own_and_answers_find_them_in_any_order() -> None:
    session = OnboardSession(first_sequence=0xFFFF)
    frames = [session.request(message, 0.0)[0] for message in (OBTAIN, TAKE_OFF, drone.Version())]
    assert [frame_of(frame).cmd_type for frame in frames] == [2, 3, 4]
    assert [frame_of(frame).sequence for frame in frames] == [0xFFFF, 0, 1]
    second = session.receive(answer(frames[1], drone.TaskAck(TaskCode.STARTED)), 0.01)
    first = session.receive(answer(frames[0], OBTAINED), 0.02)
    assert [(each.message, each.request) for each in (*second, *first)] == [
        (drone.TaskAck(TaskCode.STARTED), TAKE_OFF),
        (OBTAINED, OBTAIN),
    ]
    assert frame_of(session.request(TAKE_OFF, 0.03)[0]).cmd_type == 2
    assert session.due(0.1) == []


def test_there_are_thirty_sessions() -> None:
    session = OnboardSession()
    for number in OWN:
        assert frame_of(session.request(OBTAIN, 0.0)[0]).cmd_type == number
    with pytest.raises(BusyError, match=r"the drone has not answered 30 commands: there is no room for drone\.task"):
        session.request(TAKE_OFF, 0.0)
    assert len(session.overdue(1.1)) == 30
    session.request(TAKE_OFF, 1.1)


@pytest.mark.parametrize(("cmd_type", "sequence"), [(0x22, 1), (0x23, 0), (0x20, 0)])
def test_an_answer_in_another_session_or_with_another_number_answers_nothing(cmd_type: int, sequence: int) -> None:
    session = OnboardSession()
    session.request(OBTAIN, 0.0)
    (received,) = session.receive(Frame(OBTAINED.encode(), cmd_type, sequence).encode(), 0.0)
    assert (received.message, received.request) == (Opaque(b"", OBTAINED.encode()), None)
    assert session.counts.unmatched_replies == 1
    assert (session.counts.late_acks, session.counts.duplicate_acks) == (0, 0)


def test_duplicate_and_late_answers_are_counted_and_answer_nothing() -> None:
    session = OnboardSession()
    frame, _ = session.request(OBTAIN, 0.0)
    received = session.receive(answer(frame, OBTAINED) * 2, 0.1)
    assert [each.request for each in received] == [OBTAIN, None]
    assert (session.counts.replies, session.counts.duplicate_acks, session.counts.late_acks) == (1, 1, 0)
    lost, _ = session.request(OBTAIN, 1.0)
    session.overdue(2.1)
    session.request(TAKE_OFF, 2.1)  # in the session that is free again
    (late,) = session.receive(answer(lost, OBTAINED), 2.2)
    assert (late.message, late.request) == (OBTAINED, None)
    assert (session.counts.duplicate_acks, session.counts.late_acks, session.counts.unmatched_replies) == (1, 1, 2)


def test_an_answer_that_says_nothing_is_an_answer() -> None:
    session = OnboardSession()
    session.request(OBTAIN, 0.0)
    (received,) = session.receive(Frame(b"", 0x22, 0).encode(), 0.0)
    assert (received.message, received.request) == (Opaque(b"", b""), OBTAIN)


def test_streams_go_in_session_0_and_what_may_be_answered_in_session_1() -> None:
    session = OnboardSession()
    stream, optional = session.command(virtual_rc.NEUTRAL), session.command(drone.Version())
    assert [frame_of(frame).cmd_type for frame in (stream, optional)] == [0, 1]
    ack = drone.VersionAck(Code.OK, 7, "id", "name")
    (received,) = session.receive(answer(optional, ack), 0.0)
    assert (received.message, received.request) == (ack, None)
    assert session.counts.unmatched_replies == 0
    assert (session.due(9.0), session.overdue(9.0)) == ([], [])


@pytest.mark.parametrize("session_number", [0, 1, 2, 31])
def test_losing_control_is_acknowledged_unless_in_session_0(session_number: int) -> None:
    session = OnboardSession()
    push = Frame(drone.Pushed().data(), session_number, 119).encode()
    (received,) = session.receive(push, 0.0)
    assert received.message == drone.Pushed()
    acks = session.due(0.0)
    assert [frame_of(ack) for ack in acks] == ([Frame(b"\0\0", 0x20 | session_number, 119)] if session_number else [])
    assert session.due(0.0) == []


def test_the_published_push_has_the_published_answer() -> None:
    session, vector = OnboardSession(), VECTORS["push_lost_control_s2"]
    session.receive(bytes.fromhex(vector["hex"]) * 2, 0.0)
    assert [ack.hex() for ack in session.due(0.0)] == [vector["sdk_auto_reply"]] * 2


def test_what_must_not_be_sent_takes_neither_number_nor_session() -> None:
    session = OnboardSession()
    with pytest.raises(FieldError, match=r"drone\.sticks: roll must be 364\.\.1684, not 2000"):
        session.command(virtual_rc.Sticks(roll=2000))
    with pytest.raises(FieldError, match=r"drone\.frequency: reserved must be 0, not 9"):
        session.request(drone.Frequency(reserved=9), 0.0)
    frame = frame_of(session.request(OBTAIN, 0.0)[0])
    assert (frame.cmd_type, frame.sequence) == (2, 0)


def test_both_ends_are_sessions() -> None:
    host, far = OnboardSession(), OnboardSession()
    asked, _ = host.request(OBTAIN, 0.0)
    (command,) = far.receive(asked, 0.0)
    assert command.message == OBTAIN
    told = far.reply(command.frame, OBTAINED) + far.command(Broadcast(battery=87)) + far.request(drone.Pushed(), 0.0)[0]
    received = host.receive(told, 0.0)
    assert [each.message for each in received] == [OBTAINED, Broadcast(battery=87), drone.Pushed()]
    (acked,) = far.receive(b"".join(host.due(0.0)), 0.0)
    assert (acked.message, acked.request) == (drone.PushedAck(), drone.Pushed())


def test_with_a_key_everything_is_encrypted_and_answers_are_as_their_commands() -> None:
    key = Cipher(bytes(range(32)))
    host, far = OnboardSession(cipher=key), OnboardSession(cipher=key)
    asked, _ = host.request(TAKE_OFF, 0.0)
    assert frame_of(asked).is_encrypted
    assert host.due(0.15) == [asked]
    (command,) = far.receive(asked, 0.0)
    assert command.message == TAKE_OFF
    acknowledged = far.reply(command.frame, drone.TaskAck(TaskCode.NO_RIGHTS))
    assert frame_of(acknowledged).is_encrypted
    (received,) = host.receive(acknowledged, 0.2)
    assert (received.message, received.request) == (drone.TaskAck(TaskCode.NO_RIGHTS), TAKE_OFF)
    plain, _ = OnboardSession().request(TAKE_OFF, 0.0)
    assert not frame_of(far.reply(frame_of(plain), drone.TaskAck(TaskCode.STARTED))).is_encrypted


def test_without_the_key_what_is_encrypted_is_unknown_and_still_an_answer() -> None:
    host, far = OnboardSession(), OnboardSession(cipher=Cipher(bytes(32)))
    host.request(OBTAIN, 0.0)
    acknowledged = far.reply(Frame(b"", 2, 0, 0x20), OBTAINED)
    (received,) = host.receive(acknowledged + far.command(Broadcast(battery=1)), 0.0)[:1]
    assert isinstance(received.message, Opaque)
    assert received.request == OBTAIN
    assert host.counts.unknown == 2


some_frames = st.builds(
    Frame,
    data=st.binary(max_size=70)
    | st.sampled_from([drone.Pushed().data(), OBTAINED.encode(), virtual_rc.NEUTRAL.data()]),
    cmd_type=st.integers(0, 0x3F),
    sequence=st.integers(0, 3),
    encryption=st.sampled_from([0, 0, 0x20, 0x2D, 0x3F, 0x40]),
    reserved=st.just(bytes(3)),
    version=st.just(0),
).map(Frame.encode)


@given(st.lists(some_frames | st.binary(max_size=30)), st.booleans())
def test_receiving_never_raises(parts: list[bytes], with_key: bool) -> None:
    session: Any = OnboardSession(cipher=Cipher(bytes(32)) if with_key else None)
    for number, part in enumerate(parts):
        session.request(OBTAIN, number * 0.3)
        session.receive(part, number * 0.3)
        session.due(number * 0.3)
        session.overdue(number * 0.3)
