"""A connection: answers find who asked, silence is noticed by time and by questions together."""

import uuid

import can
import pytest
from far_end import FarEnd

from teleop.core.errors import LinkError
from teleop.devices.connection import SILENCE, UNANSWERED, Answer, Connection
from teleop.dji.frame import Frame, pieces
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Result
from teleop.links import open_link


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


WARNING = "another program is driving this gimbal (link the gimbal, memory:)"


class Shared:
    """A connection on whose bus another program drives the same gimbal: its replies come here too."""

    def __init__(self, own: int = 0, others: int = 30000) -> None:
        self.far = FarEnd()
        self.far.connection.session = Session(first_sequence=own)
        self.far.replies[gimbal.Angles] = angles_at(0.0)
        self.other = Session(first_sequence=others)

    def turn(self, now: float, own: bool = True, other: bool = True, delay: float = 0.0) -> None:
        if own:
            self.far.connection.request(gimbal.Angles(), now)
        if other:
            self.far.here.send(self.other.request(gimbal.Position(0.0, 0.0, 0.0), now)[0])
            self.far.replies[gimbal.Position] = lambda _request: Result(0)
        self.far.serve(now)
        self.far.connection.poll(now + delay + 0.001)

    @property
    def warnings(self) -> list[str]:
        return [warning.partition(":")[0] for warning in self.far.connection.warnings]


@pytest.mark.parametrize(("own", "others"), [(0, 30000), (5, 4), (100, 65000), (65500, 40)])
def test_another_program_on_the_bus_is_recognised_by_replies_to_numbers_that_were_not_sent_here(
    own: int, others: int
) -> None:
    """Whichever of two programs numbers ahead, one of them sees numbers that it has not reached."""
    here, there = Shared(own, others), Shared(others, own)
    for tick in range(50):
        here.turn(1 + tick / 20)
        there.turn(1 + tick / 20)
    said = [*here.far.connection.warnings, *there.far.connection.warnings]
    assert said
    assert all(text.startswith(WARNING) for text in said)
    assert here.far.connection.counts["foreign_replies"] + there.far.connection.counts["foreign_replies"] > 20


def test_late_and_repeated_replies_of_our_own_are_nobody_elses() -> None:
    shared = Shared(own=65530)
    connection, frames = shared.far.connection, []
    for tick in range(40):
        connection.request(gimbal.Angles(), 1 + tick / 10)
        frames.append(shared.far.link.receive())
        shared.far.push(gimbal.Joystick(pitch=0, roll=0, yaw=0))  # it is there, and leaves questions unanswered
        connection.poll(1 + tick / 10 + 0.05)
    answers = Session()
    for _twice in range(2):
        for frame in frames:
            [asked] = answers.receive(frame, 6.0)
            shared.far.link.send(answers.reply(asked.frame, angles_at(0.0)(None)))
    connection.poll(6.0)
    assert connection.counts["unmatched_replies"] == 79  # all but the one that was still waited for
    assert connection.counts["foreign_replies"] == 0
    assert not list(connection.warnings)


def test_replies_to_the_run_before_this_one_are_no_other_program() -> None:
    shared = Shared()
    for tick in range(6):
        shared.turn(tick / 50)
    assert shared.far.connection.counts["foreign_replies"] == 6
    for tick in range(100):
        shared.turn(1 + tick / 20, other=False)
    assert shared.warnings == []


def test_a_single_command_of_another_program_now_and_then_is_not_driving() -> None:
    shared = Shared()
    for tick in range(300):
        shared.turn(1 + tick / 10, other=tick % 60 == 0)
    assert shared.warnings == []
