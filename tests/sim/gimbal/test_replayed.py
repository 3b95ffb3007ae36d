"""A replayed gimbal answers as the captured one did: the same replies, as late, in their order, and its pushes."""

from __future__ import annotations

from dataclasses import replace

import pytest
from made_captures import MadeCapture

from teleop.dji.frame import REPLY, Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message
from teleop.links.can import GIMBAL_ID, HOST_ID
from teleop.sim.gimbal.captured_gimbal import CapturedGimbal, Heard, learn
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.firmware import DOCUMENTED
from teleop.sim.gimbal.replayed import ReplayedGimbal, angles_at
from teleop.sim.refusals import Why

VERSION = gimbal.VersionReply(0, 1, "03.01.00.10")


def angles(yaw: float, kind: int = gimbal.AngleKind.ATTITUDE) -> gimbal.AnglesReply:
    return gimbal.AnglesReply(0, kind, yaw, 0.0, -2.0)


def push(yaw: float) -> gimbal.ShortPush:
    return gimbal.ShortPush(True, False, False, yaw, 0.0, 0.0)


def captured(made: MadeCapture) -> CapturedGimbal:
    readers = {can_id: FrameReader(in_pieces=True) for can_id in (HOST_ID, GIMBAL_ID)}
    heard = []
    for each in made.frames:
        found = readers[each.id].feed(each.data, each.time)
        heard += [Heard(each.time, each.id == GIMBAL_ID, frame) for frame in found if isinstance(frame, Frame)]
    learned = learn(heard)
    assert learned is not None
    return learned


class Host:
    """Asks a replayed gimbal, and has what it sends with the time to the millisecond."""

    def __init__(self, made: MadeCapture) -> None:
        self.gimbal = ReplayedGimbal(captured(made))
        self._reader = FrameReader(in_pieces=True)
        self._time = 0.0

    def ask(self, message: Message, sequence: int = 7) -> None:
        self.gimbal.receive(Frame(message.data(), 0x03, sequence).encode(), self._time)

    def until(self, time: float) -> list[tuple[float, Frame]]:
        """What arrives up to `time` (s)."""
        arrived = []
        while self._time < time - 1e-9:
            self._time = round(self._time + 0.001, 3)
            found = self._reader.feed(self.gimbal.advance(self._time), self._time)
            arrived += [(self._time, frame) for frame in found if isinstance(frame, Frame)]
        return arrived

    def data(self, time: float) -> list[tuple[float, bytes]]:
        return [(at, frame.data) for at, frame in self.until(time)]


def test_a_reply_has_the_number_of_its_request_and_comes_as_late_as_in_the_capture() -> None:
    made = MadeCapture()
    made.ask(5.0, gimbal.Version(), 900)
    made.answer(5.012, VERSION, 900)
    host = Host(made)
    host.until(1.0)
    host.ask(gimbal.Version(), sequence=3)
    assert host.until(2.0) == [(1.012, Frame(VERSION.data(), REPLY, 3))]


def test_replies_to_the_same_request_come_in_their_order_and_the_last_again() -> None:
    made = MadeCapture()
    for number, pitch_max in enumerate((145, 90)):
        made.ask(number, gimbal.Limits(), number)
        made.answer(number + 0.003, gimbal.LimitsReply(0, pitch_max, 55, 179, 179, 30, 30), number)
    host = Host(made)
    seen = []
    for number in range(3):
        host.ask(gimbal.Limits(), number)
        seen += [frame.data[3] for _, frame in host.until(number + 1.0)]
    assert seen == [145, 90, 90]


def test_replies_that_overtake_each_other_do_so_again() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 1)
    made.ask(0.001, gimbal.Limits(), 2)
    made.answer(0.004, gimbal.LimitsReply(0, 145, 55, 179, 179, 30, 30), 2)
    made.answer(0.009, VERSION, 1)
    host = Host(made)
    host.ask(gimbal.Version(), 1)
    host.ask(gimbal.Limits(), 2)
    assert [(time, frame.sequence) for time, frame in host.until(1.0)] == [(0.003, 2), (0.009, 1)]


def test_forms_of_one_command_have_their_own_replies_and_numbers_do_not_matter() -> None:
    made = MadeCapture()
    recenter, lock = gimbal.Mode(action=gimbal.CenterAction.RECENTER), gimbal.Mode(gimbal.FollowMode.LOCK)
    for number, (request, code) in enumerate([(recenter, 0), (lock, 2), (gimbal.Position(10.0, 0.0, 0.0), 0)]):
        made.ask(number, request, number)
        made.answer(number + 0.002, request, number, bare=request.data()[:2] + bytes([code]))
    host = Host(made)
    answers = {}
    for request in (lock, recenter, gimbal.Position(-33.0, 1.0, 5.0), gimbal.Position(1.0, 0.0, 0.0, absolute=False)):
        host.ask(request)
        answers[request] = [frame.data[2] for _, frame in host.until(host._time + 0.5)]
    assert list(answers.values()) == [[2], [0], [0], []]
    assert host.gimbal.refusals.counts == {("gimbal.position", Why.NOT_CAPTURED): 1}


def test_what_was_not_answered_is_silent_and_what_was_never_asked_is_refused() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Stiffness(), 1)
    made.push(0.5, push(0.0))
    host = Host(made)
    host.ask(gimbal.Stiffness())
    assert host.gimbal.refusals.total == 0
    host.ask(gimbal.Version())
    assert host.gimbal.refusals.counts == {("gimbal.version", Why.NOT_CAPTURED): 1}
    assert [frame.data[:2] for _, frame in host.until(0.6)] == [b"\x0e\x08"]


def moving(bare: int | None = None) -> MadeCapture:
    """Asked every 0.1 s while yaw goes from 0 to 10 deg; `bare` leaves out that many bytes of each reply."""
    made = MadeCapture()
    for number in range(11):
        made.ask(2.0 + number * 0.1, gimbal.Angles(), number)
        reply = angles(float(number))
        data = None if bare is None else reply.encode()[:1] + reply.encode()[bare - 1 :]
        made.answer(2.005 + number * 0.1, reply, number, bare=data)
    return made


@pytest.mark.parametrize("bare", [None, 2, 3], ids=["now", "without-id", "without-type"])
def test_angles_are_those_of_the_capture_at_that_time_in_its_form(bare: int | None) -> None:
    host = Host(moving(bare))
    host.ask(gimbal.Angles())
    [(_, first)] = host.until(0.25)
    host.ask(gimbal.Angles())
    [(_, between)] = host.until(3.0)
    host.ask(gimbal.Angles())
    [(_, held)] = host.until(4.0)
    start = {None: 4, 2: 2, 3: 1}[bare]
    yaws = [int.from_bytes(frame.data[start : start + 2], "little", signed=True) for frame in (first, between, held)]
    assert yaws == [0, 25, 100]
    assert {len(frame.data) for frame in (first, between, held)} == {start + 6}


def test_a_turn_past_180_is_the_short_way() -> None:
    track = [(0.0, (179.0, 0.0, 0.0)), (1.0, (-179.0, 0.0, 0.0))]
    assert angles_at(track, 0.25)[0] == 179.5
    assert angles_at(track, 0.75)[0] == -179.5
    assert angles_at(track, 9.0)[0] == -179.0
    assert angles_at([(0.0, (350.0, 0.0, 0.0)), (1.0, (360.0, 0.0, 0.0))], 0.5)[0] == 355.0


def test_pushes_come_as_captured_and_then_hold_at_their_rate() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 1)
    made.answer(0.002, VERSION, 1)
    for number, time in enumerate((0.1, 0.2, 0.3, 0.41)):
        made.push(time, push(number), number)
    host = Host(made)
    host.until(3.0)
    host.ask(gimbal.Version())
    arrived = [(time, frame) for time, frame in host.until(3.65) if frame.data[:2] == b"\x0e\x08"]
    assert [time for time, _ in arrived] == [3.1, 3.2, 3.3, 3.41, 3.51, 3.61]
    assert [frame.data for _, frame in arrived] == [push(number).data() for number in (0, 1, 2, 3, 3, 3)]


def test_pushes_from_before_the_first_request_are_there_before_it() -> None:
    made = MadeCapture()
    for number in range(4):
        made.push(number * 0.1, push(number), number)
    made.ask(0.35, gimbal.Version(), 1)
    made.answer(0.36, VERSION, 1)
    made.push(0.45, push(9.0))
    host = Host(made)
    before = host.data(1.05)
    assert before[:4] == [(round(0.001 + number * 0.1, 3), push(number).data()) for number in range(4)]
    assert len(before) == 11
    host.ask(gimbal.Version())
    assert host.data(1.2)[-1] == (pytest.approx(1.15), push(9.0).data())


def test_pushes_that_were_switched_on_wait_for_that() -> None:
    made = MadeCapture()
    on, off = gimbal.PushSettings(gimbal.Switch.ON), gimbal.PushSettings(gimbal.Switch.OFF)
    made.ask(0.0, gimbal.Version(), 1)
    made.answer(0.002, VERSION, 1)
    made.ask(1.0, on, 2)
    made.answer(1.002, on, 2, bare=b"\x0e\x07\x00")
    made.push(1.1, push(5.0))
    made.push(1.2, push(6.0))
    made.ask(2.0, off, 3)
    made.answer(2.002, off, 3, bare=b"\x0e\x07\x00")
    host = Host(made)
    host.ask(gimbal.Version())
    assert len(host.until(2.0)) == 1
    host.ask(on)
    assert host.data(2.25) == [(2.002, b"\x0e\x07\x00"), (2.1, push(5.0).data()), (2.2, push(6.0).data())]
    host.ask(off)
    assert host.data(3.0) == [(2.252, b"\x0e\x07\x00")]


def test_a_number_that_never_changes_is_matched_by_command_and_age() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Stiffness(), 7)  # never answered
    made.ask(0.1, gimbal.Version(), 7)
    made.answer(0.105, VERSION, 7)
    made.ask(5.0, gimbal.Version(), 7)
    made.answer(5.002, replace(VERSION, version="04.00.00.00"), 7)
    learned = captured(made)
    assert [len(exchange.replies) for exchange in learned.exchanges] == [0, 1, 1]
    assert learned.last_reply(gimbal.VersionReply) == replace(VERSION, version="04.00.00.00")


def test_a_push_with_the_reply_bit_is_no_reply() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 0)
    made.answer(0.001, push(3.0), 0)
    made.answer(0.002, VERSION, 0)
    learned = captured(made)
    assert [len(exchange.replies) for exchange in learned.exchanges] == [1]
    assert len(learned.unasked) == 1


def test_nothing_of_a_gimbal_is_nothing_to_learn() -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 0)
    assert learn([]) is None
    assert learn([Heard(0.0, False, Frame(gimbal.Version().data(), 3, 1))]) is None


@pytest.mark.parametrize("legacy", [False, True])
def test_a_simulated_gimbal_and_its_replay_answer_the_same(legacy: bool) -> None:
    """The same session with both, request by request: each byte of every reply, and its time."""
    firmware = replace(DOCUMENTED, legacy_replies=legacy, reply_delay=0.004, pitch_max=155)
    real, made = SimulatedGimbal(firmware=firmware, version="03.01.00.10"), MadeCapture()
    session = Session()
    requests: dict[int, Message] = {
        0: gimbal.Version(),
        10: gimbal.Limits(),
        20: gimbal.Stiffness(),
        30: gimbal.PushSettings(gimbal.Switch.ON),
        50: gimbal.Position(20.0, 0.0, 5.0, time_for_action=0.5),
        **{tick: gimbal.Angles() for tick in range(60, 160, 4)},
        170: gimbal.Mode(gimbal.FollowMode.LOCK),
    }
    sent: dict[int, bytes] = {}
    for tick in range(400):
        time = tick * 0.01
        if tick in requests:
            sent[tick] = session.command(requests[tick])
            made.send(time, HOST_ID, sent[tick])
            real.receive(sent[tick], time)
        if data := real.advance(time):
            made.send(time, GIMBAL_ID, data)
    learned = captured(made)
    replay, again = ReplayedGimbal(learned), MadeCapture()
    for tick in range(400):
        time = tick * 0.01
        if tick in sent:
            again.send(time, HOST_ID, sent[tick])
            replay.receive(sent[tick], time)
        if data := replay.advance(time + 1e-6):
            again.send(time, GIMBAL_ID, data)
    assert again.frames == made.frames
    assert replay.refusals.total == 0
