"""One link and the session over it, shared by all that a device does: gimbal, focus motor and camera are one bus.

A connection is served by the control thread alone and never waits: a poll takes in whatever has arrived and hands
each frame to those who asked for its kind. It also decides when the far end counts as lost, because it alone sees
every byte: not by time alone, since a resting loop asks seldom, but by time and unanswered requests together.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass

from teleop.core.errors import LinkError
from teleop.core.interfaces import Link
from teleop.dji.drone import movement, virtual_rc
from teleop.dji.drone.session import OnboardSession
from teleop.dji.gimbal import focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Received, Session
from teleop.dji.message import Message
from teleop.links.buffered import BufferedLink
from teleop.links.outbox import Traffic

SILENCE = 0.5  # s without a good frame; a gimbal answers within 5 ms
UNANSWERED = 3  # requests in a row, at least: one lost reply is ordinary on a shared bus
FOREIGN, FOREIGN_WITHIN = 3, 5.0  # so many replies to others within so many s: another program is there
OWN_BEFORE = 0.3  # s after opening, in which replies to an earlier run of this program may still come
STREAMS = (gimbal.Position, gimbal.Speed, gimbal.Joystick, gimbal.Dial, focus.Set, virtual_rc.Sticks, movement.Move)
QUESTIONS = (gimbal.Angles, gimbal.PushSettings, gimbal.VersionPush, focus.Get)


@dataclass(frozen=True, slots=True)
class Answer:
    """What came of a request: its reply, None when none came in time, and when the request was `sent` (s).

    `bare` says that the reply left out set and id, as old firmware does.
    """

    sequence: int
    sent: float
    reply: Message | None
    bare: bool = False


class Connection:
    """`name` is what errors call the far end, `url` where it is; the first frame from it is expected after `now`.

    `link_counts` are what the link counts of its own: how often it was full, what it dropped. `session` is that of the
    far end's protocol, a gimbal's unless given.
    """

    def __init__(
        self,
        name: str,
        url: str,
        link: Link,
        now: float,
        link_counts: Mapping[str, int] | None = None,
        session: Session | OnboardSession | None = None,
    ) -> None:
        self.session = session or Session()
        self._link_counts = {} if link_counts is None else link_counts
        self._name, self._url, self._link = name, url, link
        self.opened = now
        self._handlers: dict[type[Message], list[Callable[[Answer], None]]] = {}
        self._push_handlers: dict[type[Message], list[Callable[[Message, float], None]]] = {}
        self._receivers: list[Callable[[Received, float], object]] = []
        self._sent: dict[int, float] = {}
        self._queue = link if isinstance(link, BufferedLink) else None
        self._latest: dict[type[Message], int] = {}  # the sequence of the last request of each stream
        self._foreign: deque[float] = deque(maxlen=FOREIGN)  # when the last replies to others came
        self._shared = False
        self._heard = self._polled = now
        self._unanswered = 0

    def __str__(self) -> str:
        return f"{self._name} on {self._url}"

    @property
    def simulated(self) -> bool:
        """Whether the far end is in this process."""
        return self._url == "sim:"

    @property
    def heard(self) -> float:
        """When the last good frame came, on the loop's clock."""
        return self._heard

    @property
    def counts(self) -> Mapping[str, int]:
        """How much has passed, and everything that went wrong without being a fault, by name."""
        counts = {**asdict(self.session.counts), **self._link_counts}
        return {**counts, "cannot_keep_up": 1} if self._behind else counts

    @property
    def foreign(self) -> int:
        """CAN frames of other ids than the gimbal's, so far; 0 on a link that has no ids."""
        return sum(getattr(self._link, "foreign", {}).values())

    @property
    def with_own_id(self) -> int:
        """CAN frames with the host's id that arrived: before anything was sent, those of another host."""
        return getattr(self._link, "with_own_id", 0)

    @property
    def warnings(self) -> Iterator[str]:
        """What is wrong with it and ends nothing, in a line each that stays the same."""
        if self._behind:
            yield (
                f"link {self._name} cannot keep up: {self._url} takes less than is sent, and older commands are"
                " skipped; set a lower rate: in the profile's sinks, or use a faster adapter"
            )
        if self._shared:
            yield (
                f"another program is driving this gimbal (link {self._name}, {self._url}): the replies to its commands"
                " arrive here; end one of the two"
            )

    @property
    def _behind(self) -> bool:
        return self._queue is not None and self._queue.behind

    def on_answer(self, request: type[Message], handler: Callable[[Answer], None]) -> None:
        """Have `handler` called with the answer to each request of a kind, and when one has none."""
        self._handlers.setdefault(request, []).append(handler)

    def on_push(self, kind: type[Message], handler: Callable[[Message, float], None]) -> None:
        """Have `handler` called with each message of a kind that comes unasked, and the time of the poll it came in."""
        self._push_handlers.setdefault(kind, []).append(handler)

    def on_received(self, handler: Callable[[Received, float], object]) -> None:
        """Have `handler` called with all that a gimbal sends, its frame included, and the time of the poll."""
        self._receivers.append(handler)

    def stream(self, message: Message) -> None:
        """Send a message that has no reply. Raises LinkError, or FieldError when a field is out of its range."""
        self._leave(message, self.session.command(message))

    def request(self, message: Message, now: float) -> int:
        """Send a message that has a reply; its sequence number. Raises as `stream` does."""
        frame, sequence = self.session.request(message, now)
        if message.has_reply:
            self._sent[sequence] = now
        if self._leave(message, frame) and isinstance(self.session, Session):
            replaced = self._latest.pop(type(message), -1)
            self.session.forget(replaced)
            self._sent.pop(replaced, None)
        self._latest[type(message)] = sequence
        return sequence

    def withdraw(self, *kinds: type[Message]) -> None:
        """Send no request of these kinds again; only a drone's are."""
        if isinstance(self.session, OnboardSession):
            self.session.withdraw(*kinds)

    def poll(self, now: float) -> None:
        """Take in what has arrived, once per tick however many ask. Raises LinkError when the far end is lost."""
        if now == self._polled:
            return
        self._polled = now
        strangers = self.session.counts.foreign_replies
        for received in self.session.receive(self._link.receive(), now):
            self._heard, self._unanswered = now, 0
            for receiver in self._receivers:
                receiver(received, now)
            if received.request is not None:
                self._answer(received.request, received.frame.sequence, received.message, received.bare)
            for handler in self._push_handlers.get(type(received.message), ()):
                handler(received.message, now)
        self._note_foreign(self.session.counts.foreign_replies - strangers, now)
        for lost in self.session.overdue(now):
            self._unanswered += 1
            self._answer(lost.request, lost.sequence, None)
        if isinstance(self.session, OnboardSession):  # whose protocol sends again what is not acknowledged
            for frame in self.session.due(now):
                self._link.send(frame)
        if self._unanswered >= UNANSWERED and now - self._heard > SILENCE:
            raise LinkError(f"{self} does not answer: is it on, is the cable in?")

    def _leave(self, message: Message, frame: bytes) -> bool:
        """Send a frame; whether it took the place of an older one of its kind, which then never leaves."""
        if self._queue is None:
            self._link.send(frame)
            return False
        return self._queue.send_as(frame, _traffic(message), type(message))

    def _note_foreign(self, count: int, now: float) -> None:
        if not count or now - self.opened < OWN_BEFORE:
            return
        self._foreign.extend([now] * count)
        self._shared |= len(self._foreign) == FOREIGN and now - self._foreign[0] <= FOREIGN_WITHIN

    def _answer(self, request: Message, sequence: int, reply: Message | None, bare: bool = False) -> None:
        answer = Answer(sequence, self._sent.pop(sequence), reply, bare)
        for handler in self._handlers.get(type(request), ()):
            handler(answer)


def _traffic(message: Message) -> Traffic:
    if isinstance(message, gimbal.Speed) and not message.take_over:  # giving back is never skipped
        return Traffic.ORDER
    if isinstance(message, STREAMS):
        return Traffic.STREAM
    return Traffic.QUESTION if isinstance(message, QUESTIONS) else Traffic.ORDER
