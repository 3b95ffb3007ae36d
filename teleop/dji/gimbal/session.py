"""One conversation over one link: numbers the frames that go out, and says what the bytes that come in mean.

It does no I/O and has no clock: it makes bytes to send, takes bytes that arrived, and time comes in as `now`. So one
thread can run it at any speed, and a test can run it without waiting. Nothing here ever waits for a reply: many
requests may be open, each is matched by its sequence number, which the gimbal echoes, and `overdue` hands back those
that were not answered in time; whether to send again is the caller's choice. A real gimbal stopped when its stream
paused for a lost reply, so a stream should use `command` and ask for nothing.

Both ends are a Session: a simulated gimbal receives requests and answers them with `reply`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

from teleop.dji.frame import Damage, Frame, FrameReader
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import REPLY, Message, Opaque
from teleop.dji.registry import Registry

RECENT: Final = 2048  # frames sent here, ten seconds of them at least: a late reply to an older one is not expected
REPLY_TIMEOUT: Final = 0.1  # s; replies normally arrive within 5 ms (docs/protocol-facts.md)


@dataclass(slots=True)
class Counts:
    """How much passed, and how much of it was not as it should be."""

    frames_out: int = 0
    frames_in: int = 0
    replies: int = 0  # that answer an open request
    unmatched_replies: int = 0  # late, twice, or to a command sent without asking
    lost_replies: int = 0
    foreign_replies: int = 0  # of the unmatched, those to numbers that were not sent here
    damage: int = 0  # runs of bytes that were no frame
    unknown: int = 0  # frames that no message class describes


class Received(NamedTuple):
    """A message that arrived in `frame`; `request` is what it answers, None unless it answers an open request.

    `bare` says that the frame left out set and id, as old firmware does.
    """

    message: Message
    frame: Frame
    request: Message | None = None
    bare: bool = False


class Lost(NamedTuple):
    """A request that was sent at `sent` (seconds) and not answered in time."""

    request: Message
    sequence: int
    sent: float


class _Open(NamedTuple):
    request: Message
    sent: float
    deadline: float


class Session:
    """One end of a link. `first_sequence` numbers the first frame; they wrap at 65535."""

    def __init__(self, registry: Registry = R_SDK, first_sequence: int = 0) -> None:
        self.counts = Counts()
        self._registry = registry
        self._sequence = first_sequence
        self.last_damage: Damage | None = None  # the bytes that were no frame, most recently
        self._sent = 0  # frames, up to RECENT
        self._reader = FrameReader(in_pieces=True)
        self._open: dict[int, _Open] = {}

    def command(self, message: Message) -> bytes:
        """The frame that sends `message`, whose reply, if any, will not be missed. Raises FieldError."""
        return self._send(message)[0]

    def push(self, message: Message) -> bytes:
        """The frame that pushes `message`, as a device does: its values may be beyond the document's tables."""
        return self._send(message, checked=False)[0]

    def request(self, message: Message, now: float, timeout: float = REPLY_TIMEOUT) -> tuple[bytes, int]:
        """The frame that sends `message`, and its sequence number; a reply is due `timeout` seconds after `now`.

        A message that has no reply opens no request, so none can be lost. Raises FieldError.
        """
        frame, sequence = self._send(message)
        if not message.has_reply:
            return frame, sequence
        if sequence in self._open:  # 65536 requests ago, and the overdue ones were never collected
            self.counts.lost_replies += 1
        self._open[sequence] = _Open(message, now, now + timeout)
        return frame, sequence

    def reply(self, frame: Frame, message: Message, bare: bool = False) -> bytes:
        """The frame that answers `frame` with `message`; `bare` leaves out set and id, as old firmware does."""
        value = message.encode()
        data = value if bare else frame.data[:2] + value
        self.counts.frames_out += 1
        return Frame(data, REPLY, frame.sequence).encode()

    def receive(self, data: bytes, now: float) -> list[Received]:
        """What the bytes that arrived at `now` complete. Never raises: what is damaged or unknown is counted."""
        received = []
        for found in self._reader.feed(data, now):
            if isinstance(found, Frame):
                received.append(self._understand(found))
            elif not found.is_padding:
                self.counts.damage += 1
                self.last_damage = found
        return received

    def overdue(self, now: float) -> list[Lost]:
        """The requests whose replies are later than their timeout at `now`; they are forgotten."""
        lost = [
            Lost(waiting.request, sequence, waiting.sent)
            for sequence, waiting in self._open.items()
            if now > waiting.deadline
        ]
        for late in lost:
            del self._open[late.sequence]
        self.counts.lost_replies += len(lost)
        return lost

    def forget(self, sequence: int) -> None:
        """No reply is waited for any more: the request has not left."""
        self._open.pop(sequence, None)

    def _send(self, message: Message, checked: bool = True) -> tuple[bytes, int]:
        if checked:
            message.check()
        sequence = self._sequence
        frame = Frame(message.data(), message.cmd_type, sequence).encode()
        self._sequence = sequence + 1 & 0xFFFF
        self._sent = min(self._sent + 1, RECENT)
        self.counts.frames_out += 1
        return frame, sequence

    def _understand(self, frame: Frame) -> Received:
        waiting = self._open.get(frame.sequence) if frame.is_reply else None
        asked = waiting.request.data()[:2] if waiting else b""
        decoded = self._registry.decode(frame, asked)
        self.counts.frames_in += 1
        self.counts.unknown += isinstance(decoded.message, Opaque)
        if waiting and decoded.set_and_id == asked:
            del self._open[frame.sequence]
            self.counts.replies += 1
            return Received(decoded.message, frame, waiting.request, decoded.bare)
        if frame.is_reply and not self._registry.is_push(decoded.set_and_id):  # some firmware marks pushes as replies
            self.counts.unmatched_replies += 1
            self.counts.foreign_replies += not 0 < (self._sequence - frame.sequence & 0xFFFF) <= self._sent
        return Received(decoded.message, frame)
