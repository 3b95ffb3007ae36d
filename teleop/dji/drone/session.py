"""One conversation with the drone: numbers what goes out, sends again what is not acknowledged, says what comes in.

Like session.py it does no I/O and has no clock: bytes and `now` in, bytes out. What differs is the protocol's. A
command is sent in session 0 and never acknowledged, or in a session of its own, 2 to 31, until its acknowledgement
comes; that is a value alone, so session and sequence are all that says what it answers. Sending again means the same
bytes again. It never happens late: after a stall of this computer a command whose time is over is lost, because what
an operator wanted seconds ago (to take off, to get control) must not happen now. Nor is an order sent again after a
newer one of its kind, or once it is withdrawn: taking off must not follow landing, nor obtaining control its release.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

from teleop.core.errors import DeviceError
from teleop.dji.drone import messages as drone
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.onboard_sdk import M100, SESSION, OnboardRegistry
from teleop.dji.frame import REPLY, Damage, Frame, FrameReader
from teleop.dji.gimbal.session import Counts, Lost, Received
from teleop.dji.message import Message, Opaque

OPTIONAL: Final = 1  # the session of what may be acknowledged and is not waited for
OWN: Final = range(2, 32)  # the sessions of one command each


class Sends(NamedTuple):
    """How long an acknowledgement may take (s), and how often its command is sent in all."""

    timeout: float
    sends: int


SENDS: Final[Mapping[type[Message], Sends]] = {
    drone.Version: Sends(0.1, 3),
    drone.Activate: Sends(1.0, 3),
    drone.Frequency: Sends(0.1, 1),
    drone.A3Frequency: Sends(0.1, 1),
    drone.Control: Sends(0.5, 2),
    drone.Task: Sends(0.1, 3),
}
"""docs/protocol-facts.md."""
ONCE: Final = Sends(0.1, 1)  # what the table does not have, arming above all

REMEMBERED: Final = 64  # exchanges, to tell late and repeated acknowledgements from strange ones


class BusyError(DeviceError):
    """Every session waits for an acknowledgement."""


@dataclass(slots=True)
class OnboardCounts(Counts):
    """`unmatched_replies` are those of the other two and those that answer nothing known."""

    sent_again: int = 0
    late_acks: int = 0  # of commands given up
    duplicate_acks: int = 0


@dataclass(slots=True)
class _Exchange:
    """A command in a session of its own: when it was sent first and `last` (s), and how many `times`."""

    request: Message
    sequence: int
    frame: bytes
    sent: float
    last: float
    sends: Sends
    times: int = 1
    answered: bool = False
    wanted: bool = True

    def over(self, now: float) -> bool:
        """Whether the time of all its sends is over."""
        return now > self.sent + self.sends.timeout * self.sends.sends

    def due(self, now: float) -> bool:
        """Whether it has to be sent again."""
        late = now > self.last + self.sends.timeout
        return self.wanted and self.times < self.sends.sends and late and not self.over(now)


class OnboardSession:
    """One end of a link. Frames are numbered from `first_sequence`; they wrap at 65535.

    `cipher`, from when it is set, encrypts what is sent, and what arrives encrypted is decrypted with it.
    """

    def __init__(self, registry: OnboardRegistry = M100, first_sequence: int = 0, cipher: Cipher | None = None) -> None:
        self.counts = OnboardCounts()
        self.cipher = cipher
        self._registry = registry
        self._sequence = first_sequence
        self.last_damage: Damage | None = None  # the bytes that were no frame, most recently
        self._reader = FrameReader()
        self._open: dict[int, _Exchange] = {}  # by session
        self._past: dict[tuple[int, int], _Exchange] = {}  # by session and sequence: the last REMEMBERED
        self._acks: list[bytes] = []

    def command(self, message: Message) -> bytes:
        """The frame that sends `message`, whose acknowledgement, if any, will not be missed. Raises FieldError."""
        session = OPTIONAL if message.cmd_type else 0
        frame, sequence = self._send(message, session)
        if session == OPTIONAL:
            self._remember(session, _Exchange(message, sequence, frame, 0.0, 0.0, ONCE))
        return frame

    def request(self, message: Message, now: float) -> tuple[bytes, int]:
        """The frame that sends `message`, and its sequence number; `due` has it again until it is acknowledged.

        An older one of its kind is not sent again.

        Raises FieldError, or BusyError when too much is unanswered.
        """
        session = next((each for each in OWN if each not in self._open), None)
        if session is None:
            raise BusyError(f"the drone has not answered {len(OWN)} commands: there is no room for {message.name}")
        frame, sequence = self._send(message, session)
        self.withdraw(type(message))
        self._open[session] = _Exchange(message, sequence, frame, now, now, SENDS.get(type(message), ONCE))
        return frame, sequence

    def withdraw(self, *kinds: type[Message]) -> None:
        """Send nothing of these kinds again; an acknowledgement may still come, of what the drone has received."""
        for exchange in self._open.values():
            if isinstance(exchange.request, kinds):
                exchange.wanted = False

    def reply(self, frame: Frame, message: Message) -> bytes:
        """The frame that acknowledges `frame` with `message`, encrypted when that was."""
        cipher = self.cipher if frame.is_encrypted else None
        data, encryption = cipher.encrypt(message.encode()) if cipher else (message.encode(), 0)
        self.counts.frames_out += 1
        return Frame(data, REPLY | frame.cmd_type & SESSION, frame.sequence, encryption).encode()

    def receive(self, data: bytes, now: float) -> list[Received]:
        """What the bytes that arrived at `now` complete. Never raises: what is damaged or unknown is counted."""
        received = []
        for found in self._reader.feed(data, now):
            if isinstance(found, Frame):
                received.append(self._understand(found))
            else:
                self.counts.damage += 1
                self.last_damage = found
        return received

    def due(self, now: float) -> list[bytes]:
        """What has to be sent now: acknowledgements of pushes, and commands whose own are late, byte for byte."""
        frames, self._acks = self._acks, []
        for exchange in self._open.values():
            if exchange.due(now):
                exchange.times += 1
                exchange.last = now
                frames.append(exchange.frame)
                self.counts.sent_again += 1
                self.counts.frames_out += 1
        return frames

    def overdue(self, now: float) -> list[Lost]:
        """The commands that were not acknowledged after their last send at `now`; they are given up."""
        given_up = {session: exchange for session, exchange in self._open.items() if exchange.over(now)}
        for session in given_up:
            self._remember(session, self._open.pop(session))
        self.counts.lost_replies += len(given_up)
        return [Lost(exchange.request, exchange.sequence, exchange.sent) for exchange in given_up.values()]

    def _send(self, message: Message, session: int) -> tuple[bytes, int]:
        message.check()
        data, encryption = self.cipher.encrypt(message.data()) if self.cipher else (message.data(), 0)
        sequence = self._sequence
        frame = Frame(data, session, sequence, encryption).encode()
        self._sequence = sequence + 1 & 0xFFFF
        self.counts.frames_out += 1
        return frame, sequence

    def _understand(self, frame: Frame) -> Received:
        deciphered = self.cipher.decrypt(frame) if self.cipher and frame.is_encrypted else None
        plain = deciphered.frame if deciphered else frame
        exchange = self._exchange_of(frame) if frame.is_reply else None
        decoded = self._registry.decode(plain, exchange.request.data()[:2] if exchange else b"")
        self.counts.frames_in += 1
        self.counts.unknown += isinstance(decoded.message, Opaque)
        if isinstance(decoded.message, drone.Pushed) and frame.cmd_type & SESSION:
            self._acks.append(self.reply(frame, drone.PushedAck()))
        return Received(decoded.message, frame, self._answered(frame, exchange) if frame.is_reply else None)

    def _exchange_of(self, ack: Frame) -> _Exchange | None:
        """What `ack` answers, or has answered before, or is too late for."""
        session = ack.cmd_type & SESSION
        waiting = self._open.get(session)
        if waiting and waiting.sequence == ack.sequence:
            return waiting
        return self._past.get((session, ack.sequence))

    def _answered(self, ack: Frame, exchange: _Exchange | None) -> Message | None:
        """The command that `ack` answers, None when it answers none that is waited for."""
        session = ack.cmd_type & SESSION
        if exchange and self._open.get(session) is exchange:
            exchange.answered = True
            self._remember(session, self._open.pop(session))
            self.counts.replies += 1
            return exchange.request
        if exchange is None or session != OPTIONAL:
            self.counts.unmatched_replies += 1
        if exchange and session != OPTIONAL:
            self.counts.duplicate_acks += exchange.answered
            self.counts.late_acks += not exchange.answered
        return None

    def _remember(self, session: int, exchange: _Exchange) -> None:
        self._past[session, exchange.sequence] = exchange
        if len(self._past) > REMEMBERED:
            del self._past[next(iter(self._past))]
