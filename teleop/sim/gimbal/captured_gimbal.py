"""What a capture tells of a gimbal: which replies belong to which request, how late, and what it sends unasked.

A reply has the sequence number of its request, which some programs never change. So it answers the oldest request of
that number that is still open, is not older than a second and, where the reply names its command, is of that command.
What answers nothing was sent unasked.
"""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from teleop.dji.frame import Frame
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import Message

OPEN = 1.0  # s for which a request may still be answered: far more than any gimbal takes
_SETS = gimbal.GIMBAL, camera.CAMERA  # the first byte of a reply that names its command

ANSWERED_BY: Mapping[bytes, bytes] = {
    gimbal.Push.set_and_id: gimbal.PushSettings.set_and_id,
    gimbal.Calibration.set_and_id: gimbal.Calibrate.set_and_id,
}
"""What is sent unasked, but only after this command."""


class Heard(NamedTuple):
    """A frame of the capture, `time` in s."""

    time: float
    from_gimbal: bool
    frame: Frame


class Sent(NamedTuple):
    """A frame of the gimbal: `time` (s) of what it sent unasked, the delay of a reply; `order` on the bus."""

    time: float
    frame: Frame
    order: int


@dataclass
class Exchange:
    """A request at `time` (s) and each of its replies; none, when it was not answered."""

    time: float
    request: Frame
    replies: list[Sent] = field(default_factory=list)

    def may_be(self, heard: Heard) -> bool:
        """Whether `heard` can be a reply to it."""
        if not 0.0 <= heard.time - self.time <= OPEN:
            return False
        data = heard.frame.data
        return data[:2] == self.request.data[:2] or (bool(data) and data[0] not in _SETS)


Sample = tuple[float, tuple[float, float, float]]  # s; yaw, roll and pitch in deg


@dataclass(frozen=True)
class CapturedGimbal:
    """All of a capture, in order; `start` and `end` are the times of its first and last frame (s)."""

    start: float
    end: float
    exchanges: Sequence[Exchange]
    unasked: Sequence[Sent]

    @property
    def first_request(self) -> float:
        """When the host began to speak; the end, if it never did."""
        return self.exchanges[0].time if self.exchanges else self.end

    def angles(self) -> dict[bytes, list[Sample]]:
        """The angles in the replies to each form of the question for them."""
        tracks: dict[bytes, list[Sample]] = {}
        for exchange in self.exchanges:
            for reply in exchange.replies:
                message = R_SDK.decode(reply.frame, exchange.request.data[:2]).message
                if (angles := angles_of(message)) is not None:
                    tracks.setdefault(exchange.request.data, []).append((exchange.time + reply.time, angles))
        return tracks

    def last_reply(self, kind: type[Message]) -> Message | None:
        """The last good reply of this class."""
        for exchange in reversed(self.exchanges):
            for reply in reversed(exchange.replies):
                message = R_SDK.decode(reply.frame, exchange.request.data[:2]).message
                if isinstance(message, kind):
                    return message
        return None

    @property
    def names_commands(self) -> bool | None:
        """Whether its replies have set and id, None if there are none."""
        for exchange in self.exchanges:
            for reply in exchange.replies:
                return reply.frame.data[:2] == exchange.request.data[:2]
        return None

    @property
    def push_period(self) -> float | None:
        """Seconds between two pushes of parameters, None for less than two of them."""
        return period([sent.time for sent in self.unasked if sent.frame.data[:2] == gimbal.Push.set_and_id])


def learn(heard: Iterable[Heard]) -> CapturedGimbal | None:
    """The gimbal of a capture, whose frames are in the order of the bus; None when no frame is a gimbal's."""
    exchanges: list[Exchange] = []
    open_by_number: dict[int, list[Exchange]] = {}
    unasked: list[Sent] = []
    start = end = None
    for order, each in enumerate(heard):
        start, end = each.time if start is None else start, each.time
        waiting = open_by_number.setdefault(each.frame.sequence, [])
        if not each.from_gimbal:
            waiting[:] = [exchange for exchange in waiting if each.time - exchange.time <= OPEN]
            if not each.frame.is_reply and each.frame.data:
                exchanges.append(Exchange(each.time, each.frame))
                waiting.append(exchanges[-1])
        elif exchange := _answered(waiting, each):
            exchange.replies.append(Sent(each.time - exchange.time, each.frame, order))
        else:
            unasked.append(Sent(each.time, each.frame, order))
    if start is None or end is None or not (unasked or any(exchange.replies for exchange in exchanges)):
        return None
    return CapturedGimbal(start, end, exchanges, unasked)


def _answered(waiting: Sequence[Exchange], heard: Heard) -> Exchange | None:
    if not heard.frame.is_reply or heard.frame.data[:2] in ANSWERED_BY:
        return None
    fitting = [exchange for exchange in waiting if exchange.may_be(heard)]
    unanswered = [exchange for exchange in fitting if not exchange.replies]
    return unanswered[0] if unanswered else fitting[-1] if fitting else None


def angles_of(message: Message) -> tuple[float, float, float] | None:
    """Yaw, roll and pitch (deg) in a reply, None if it has none."""
    if isinstance(message, gimbal.LegacyAnglesReply):
        return message.yaw, message.roll, message.pitch
    if isinstance(message, gimbal.AnglesReply) and message.kind != gimbal.AngleKind.NONE:
        return message.yaw, message.roll, message.pitch
    return None


def period(times: Sequence[float]) -> float | None:
    """The usual time between two of `times`, None for less than two."""
    gaps = [after - before for before, after in itertools.pairwise(times) if after > before]
    return statistics.median(gaps) if gaps else None
