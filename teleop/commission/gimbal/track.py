"""Where a gimbal on the bench is: its angles, as they come in answers and in pushes."""

from __future__ import annotations

from collections import deque
from statistics import fmean

from teleop.commission.gimbal.places import Places
from teleop.core.errors import DeviceError
from teleop.devices.connection import Answer, Connection
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.dji.message import Message

KEPT = 15.0  # s for which readings are kept
STILL, STILL_SPREAD = 0.3, 0.15  # an axis that moves less (deg) in so many s rests
IN_VAIN = 3  # questions in a row without an answer: from then on pushes count


class Track:
    """The readings of the last KEPT s; `now` is the bench's time.

    `swapped` is whether roll and pitch are exchanged in the replies, as far as it is known.
    """

    def __init__(self) -> None:
        self.now = 0.0
        self.swapped = False
        self.noise = 0.0  # deg
        self.bare = self.legacy = False
        self.replied = self.lost = 0  # questions for the angles; those that are still on their way are in neither
        self.reply_times: deque[float] = deque(maxlen=200)  # s
        self._places: deque[Places] = deque()
        self._unanswered = 0

    def listen(self, connection: Connection) -> None:
        """To a link that was just opened: what was read before it was lost says nothing any more."""
        self._places.clear()
        self._unanswered = 0
        connection.on_answer(gimbal.Angles, self._told)
        connection.on_push(gimbal.Push, self._pushed)
        connection.on_push(gimbal.ShortPush, self._pushed)

    def forget_old(self) -> None:
        while self._places and self.now - self._places[0].time > KEPT:
            self._places.popleft()

    @property
    def last(self) -> tuple[float, float, float] | None:
        """The newest reading as yaw, roll, pitch, None before the first."""
        return self.ordered(self._places[-1]) if self._places else None

    @property
    def is_silent(self) -> bool:
        """Whether questions for the angles stay unanswered."""
        return self._unanswered > IN_VAIN

    @property
    def reads(self) -> bool:
        """Whether angles arrive."""
        return bool(self._places) and self.now - self._places[-1].time < 1.5

    def since(self, time: float) -> list[Places]:
        """The readings asked for after `time`, each in the order yaw, roll, pitch."""
        recent: list[Places] = []
        for each in reversed(self._places):
            if each.time <= time:
                break
            recent.append(Places(each.time, self.ordered(each), each.pushed))
        return recent[::-1]

    def ordered(self, places: Places) -> tuple[float, float, float]:
        """As yaw, roll, pitch. Pushes are not known to have another order than the document's."""
        yaw, second, third = places.angles
        return (yaw, third, second) if self.swapped and not places.pushed else places.angles

    def mean(self, seconds: float = STILL) -> tuple[float, float, float]:
        """Where it is, over the last readings. Raises DeviceError without any."""
        angles = [each.angles for each in self.since(self.now - seconds)]
        if not angles:
            if self.last is None:
                raise DeviceError("no angles arrive: neither in answers nor in pushes")
            angles = [self.last]
        first = angles[0]
        unrolled = [[a + 360 * round((b - a) / 360) for a, b in zip(each, first, strict=True)] for each in angles]
        yaw, roll, pitch = (fmean(column) for column in zip(*unrolled, strict=True))
        return yaw, roll, pitch

    @property
    def still(self) -> bool:
        """Whether the last readings are of one place."""
        recent = [each.angles for each in self.since(self.now - STILL)]
        if len(recent) < 2:
            return bool(recent)
        spread = STILL_SPREAD + 4 * self.noise
        return all(max(column) - min(column) <= spread for column in zip(*recent, strict=True))

    def _told(self, answer: Answer) -> None:
        reply = answer.reply
        if reply is None:
            self._unanswered += 1
            self.lost += 1
            return
        self._unanswered = 0
        self.replied += 1
        self.reply_times.append(self.now - answer.sent)
        if not isinstance(reply, gimbal.LegacyAnglesReply | gimbal.AnglesReply) or reply.return_code:
            return
        legacy = isinstance(reply, gimbal.LegacyAnglesReply)
        if isinstance(reply, gimbal.LegacyAnglesReply) or reply.kind == AngleKind.ATTITUDE:
            self.bare, self.legacy = answer.bare, legacy
            self._add(Places(answer.sent, (reply.yaw, reply.roll, reply.pitch)))

    def _pushed(self, push: Message, now: float) -> None:
        if isinstance(push, gimbal.Push | gimbal.ShortPush) and push.angles_valid and self.is_silent:
            self._add(Places(now, (push.yaw, push.roll, push.pitch), pushed=True))

    def _add(self, places: Places) -> None:
        if not self._places or places.time > self._places[-1].time:
            self._places.append(places)
