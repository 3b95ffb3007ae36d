"""A connection: answers find who asked, silence is noticed by time and by questions together."""

import uuid

import can
import pytest
from far_end import FarEnd

from teleop.dji import gimbal
from teleop.dji.frame import Frame, pieces
from teleop.dji.message import Result
from teleop.links import open_link
from teleop.ports import LinkError
from teleop.sinks.connection import SILENCE, UNANSWERED, Answer, Connection


def angles_at(yaw: float):
    return lambda _request: gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, yaw, 0.0, 0.0)


def test_an_answer_comes_to_who_asked_with_the_time_of_the_question() -> None:
    far, answers = FarEnd(), []
    far.replies[gimbal.Angles] = angles_at(12.5)
    far.connection.on_answer(gimbal.Angles, answers.append)
    sequence = far.connection.request(gimbal.Angles(), 1.0)
    far.connection.request(gimbal.Limits(), 1.0)
    far.serve(1.002)
    far.connection.poll(1.01)
    assert answers == [Answer(sequence, 1.0, gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 12.5, 0.0, 0.0))]


def test_a_refusal_is_an_answer_and_so_is_none_at_all() -> None:
    far, answers = FarEnd(), []
    far.replies[gimbal.Position] = lambda _request: Result(2)
    far.connection.on_answer(gimbal.Position, answers.append)
    far.connection.on_answer(gimbal.Limits, answers.append)
    far.connection.request(gimbal.Position(0.0, 0.0, 0.0), 1.0)
    unanswered = far.connection.request(gimbal.Limits(), 1.0)
    far.serve(1.0)
    far.connection.poll(1.01)
    far.connection.poll(1.12)
    assert [answer.reply for answer in answers] == [Result(2), None]
    assert answers[1].sequence == unanswered


def test_silence_after_questions_is_a_lost_link() -> None:
    far, polled = FarEnd(), []

    def ask_for_five_seconds() -> None:
        for number in range(100):
            far.connection.request(gimbal.Angles(), number * 0.05)
            polled.append(number * 0.05 + 0.05)
            far.connection.poll(polled[-1])

    with pytest.raises(LinkError, match="the gimbal on memory: does not answer"):
        ask_for_five_seconds()
    assert SILENCE < polled[-1] < SILENCE + 0.2


def test_silence_without_questions_is_no_loss_nor_are_single_lost_replies() -> None:
    far = FarEnd()
    far.replies[gimbal.Angles] = angles_at(0.0)
    far.connection.poll(1000.0)
    for number in range(100):
        now = 1000.0 + number
        far.connection.request(gimbal.Angles(), now)
        if number % UNANSWERED:
            far.serve(now)
        else:
            far.link.receive()
        far.connection.poll(now + 0.5)


def test_everything_that_is_asked_for_in_a_tick_costs_one_poll() -> None:
    far, answers = FarEnd(), []
    far.connection.on_answer(gimbal.Angles, answers.append)
    far.replies[gimbal.Angles] = angles_at(0.0)
    far.connection.request(gimbal.Angles(), 0.5)
    far.connection.poll(0.6)
    far.serve(0.6)
    far.connection.poll(0.6)
    assert answers == []
    far.connection.poll(0.61)
    assert len(answers) == 1


@pytest.mark.parametrize("filler", [0x00, 0xAA, 0x5C])
def test_a_bus_as_it_is_costs_no_reply_and_counts_no_damage(filler: int) -> None:
    """A second of the gimbal's own traffic before the first reply, empty CAN frames, and last ones filled up."""
    channel = str(uuid.uuid4())
    with can.Bus(channel, interface="virtual", ignore_config=True) as bus:
        link = open_link(f"virtual:{channel}", now=lambda: 0.0)
        connection, answers = Connection("the gimbal", "memory:", link, 0.0), []
        connection.on_answer(gimbal.Angles, answers.append)
        sequence = connection.request(gimbal.Angles(), 1.0)

        def send(can_id: int, data: bytes) -> None:
            bus.send(can.Message(arbitration_id=can_id, is_extended_id=False, data=data))

        for number in range(400):
            send((0x530, 0x531, 0x426)[number % 3], bytes(8))
        for piece in pieces(Frame(bytes.fromhex("0e02 00 01 0a00 0000 0000"), 0x20, sequence).encode()):
            send(0x222, b"")
            send(0x222, piece.ljust(8, bytes((filler,))))
            send(0x530, b"\xaa" * 8)
        connection.poll(1.01)
        link.close()
    assert [answer.reply for answer in answers] == [gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 1.0, 0.0, 0.0)]
    assert connection.counts["damage"] == connection.counts["unmatched_replies"] == 0
    assert connection.counts["frames_in"] == 1
    assert link.foreign.total() == 404  # type: ignore[attr-defined]  # a CanLink has it


def test_what_has_no_reply_is_never_waited_for() -> None:
    far = FarEnd()
    for number in range(UNANSWERED * 2):
        far.connection.request(gimbal.Joystick(0, 0, 0), number / 10)
    far.connection.poll(10 * SILENCE)
    assert far.connection.counts["lost_replies"] == 0
