"""A gimbal that answers as a captured one did: no model, nothing but the capture.

Its time begins with the host's first request, which is the first request of the capture. A request is answered by the
replies to the same request in the capture, in their order and after their delays; the last of them again, once there
are no more. A request with other numbers in it (another target, another speed) is answered as one of the same form. To
a request whose form the capture does not have there is no reply, and `refusals` has it.

It cannot move: the angles that it reports are those of the capture at that time, straight between two of them, and the
last ones after the end.
"""

from __future__ import annotations

import bisect
import heapq
from collections import Counter, defaultdict
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from itertools import count
from operator import attrgetter, itemgetter

from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import Message, Opaque
from teleop.sim.gimbal.captured_gimbal import ANSWERED_BY, CapturedGimbal, Exchange, Sample, Sent, angles_of
from teleop.sim.gimbal.replayed_pushes import GRAIN, ReplayedPushes
from teleop.sim.refusals import Refusals, Why, command_name

_TURN = 360.0  # deg


class ReplayedGimbal:
    """A device at the far end of a link, as `sim.link.Device`."""

    def __init__(self, captured: CapturedGimbal) -> None:
        self.captured = captured
        self.counts: Counter[str] = Counter()  # messages by name
        self.refusals = Refusals()
        self._reader = FrameReader(in_pieces=True)
        self._exact: defaultdict[bytes, list[Exchange]] = defaultdict(list)
        self._alike: defaultdict[Hashable, list[Exchange]] = defaultdict(list)
        for exchange in captured.exchanges:
            data = exchange.request.data
            self._exact[data].append(exchange)
            self._alike[form(data)].append(exchange)
        self._tracks = captured.angles()
        self._answered: Counter[Hashable] = Counter()
        self._before, self._after, self._asked_for = _streams(captured)
        self._began: float | None = None  # s: the host's first request
        self._due: list[tuple[float, int, int, bytes]] = []
        self._count = count()

    @property
    def seconds(self) -> float:
        """How long the capture is from the host's first request on."""
        return self.captured.end - self.captured.first_request

    def receive(self, data: bytes, now: float) -> None:
        """Bytes that arrive at `now`."""
        for found in self._reader.feed(data, now):
            if isinstance(found, Frame):
                self._hear(found, now)
            elif not found.is_padding:
                self.refusals.add_damage(now, found)

    def advance(self, now: float) -> bytes:
        """What it has sent up to `now`."""
        if self._began is None:
            for pushes in self._before:
                pushes.start(now)
        for pushes in (*self._before, *self._after, *self._asked_for.values()):
            for push in pushes.due(now):
                self._send(push)
        sent = bytearray()
        while self._due and self._due[0][0] <= now + GRAIN:
            sent += heapq.heappop(self._due)[-1]
        return bytes(sent)

    def _hear(self, frame: Frame, now: float) -> None:
        message = R_SDK.decode(frame).message
        if frame.is_reply:
            self.refusals.add(now, command_name(message), Why.REPLY)
            return
        self.counts[message.name] += 1
        self._begin(now)
        exchange = self._exchange(frame, message, now)
        if exchange is None:
            self.refusals.add(now, command_name(message), Why.NOT_CAPTURED)
            return
        for reply in exchange.replies:
            data = self._reported(exchange, reply.frame, now + reply.time)
            answer = reply.frame._replace(data=data, sequence=frame.sequence)
            self._send(Sent(now + reply.time, answer, reply.order))
        if started := self._asked_for.get(frame.data[:2]):
            switched_off = isinstance(message, gimbal.PushSettings) and message.switch == gimbal.Switch.OFF
            started.stop() if switched_off else started.start(now)

    def _begin(self, now: float) -> None:
        if self._began is not None:
            return
        self._began = now
        for before, after in zip(self._before, self._after, strict=True):
            if after.is_empty:
                continue  # it goes on as before
            before.stop()
            after.start(now)

    def _exchange(self, frame: Frame, message: Message, now: float) -> Exchange | None:
        """What happened in the capture after this request, or after one of its form."""
        key: Hashable = frame.data
        fitting = self._exact.get(frame.data)
        if not fitting:
            key = form(frame.data)
            fitting = self._alike.get(key)
        if not fitting:
            return None
        if isinstance(message, gimbal.Angles):  # asked at any rate: what counts is the time
            index = bisect.bisect_right(fitting, self._captured_time(now), key=attrgetter("time")) - 1
            return fitting[max(0, index)]
        self._answered[key] += 1
        return fitting[min(self._answered[key], len(fitting)) - 1]

    def _reported(self, exchange: Exchange, reply: Frame, time: float) -> bytes:
        """The data of a reply that is sent at `time`, with the angles of that time if it has any."""
        track = self._tracks.get(exchange.request.data)
        decoded = R_SDK.decode(reply, exchange.request.data[:2])
        if track is None or angles_of(decoded.message) is None:
            return reply.data
        yaw, roll, pitch = angles_at(track, self._captured_time(time))
        message = replace(decoded.message, yaw=yaw, roll=roll, pitch=pitch)  # type: ignore[call-arg]
        return (b"" if decoded.bare else decoded.set_and_id) + message.encode()

    def _captured_time(self, now: float) -> float:
        return self.captured.first_request + now - (now if self._began is None else self._began)

    def _send(self, sent: Sent) -> None:
        """Of what is due at the same time, that comes first which did so in the capture."""
        heapq.heappush(self._due, (round(sent.time, 6), sent.order, next(self._count), sent.frame.encode()))


def form(data: bytes) -> Hashable:
    """What requests have in common that differ in numbers only: class and words; of an unknown one all of it."""
    message = R_SDK.decode(Frame(data)).message
    if isinstance(message, Opaque):
        return data
    fields = message.fields().items()
    kept = {name: value for name, value in fields if isinstance(value, bool) or not isinstance(value, float | int)}
    return type(message), repr(kept)


def angles_at(track: Sequence[Sample], time: float) -> tuple[float, float, float]:
    """Straight between two samples, the short way round; before the first and after the last as there."""
    index = bisect.bisect_right(track, time, key=itemgetter(0))
    if index == 0 or index == len(track):
        return track[max(0, index - 1)][1]
    (begin, before), (end, after) = track[index - 1], track[index]
    share = (time - begin) / (end - begin)
    yaw, roll, pitch = (_between(a, b, share) for a, b in zip(before, after, strict=True))
    return yaw, roll, pitch


def _between(before: float, after: float, share: float) -> float:
    way = (after - before + _TURN / 2) % _TURN - _TURN / 2
    angle = before + share * way
    turned = (angle + _TURN / 2) % _TURN - _TURN / 2
    return round(turned if abs(before) <= _TURN / 2 and abs(after) <= _TURN / 2 else angle, 1)


def _streams(
    captured: CapturedGimbal,
) -> tuple[list[ReplayedPushes], list[ReplayedPushes], Mapping[bytes, ReplayedPushes]]:
    """What it sends unasked: before the host's first request, after it, and after a command of the host's."""
    kinds: defaultdict[bytes, list[Sent]] = defaultdict(list)
    for sent in captured.unasked:
        kinds[sent.frame.data[:2]].append(sent)
    before, after, asked_for = [], [], {}
    first = captured.first_request
    for kind, pushes in kinds.items():
        command = ANSWERED_BY.get(kind, b"")
        cause = next((each.time for each in captured.exchanges if _starts(each.request, command)), None)
        if cause is not None and cause <= pushes[0].time:
            asked_for[command] = ReplayedPushes(cause, pushes)
            continue
        before.append(ReplayedPushes(captured.start, [push for push in pushes if push.time < first]))
        after.append(ReplayedPushes(first, [push for push in pushes if push.time >= first]))
    return before, after, asked_for


def _starts(request: Frame, command: bytes) -> bool:
    """Whether this request is what makes a gimbal push: of the switch for pushes only `on` is."""
    if not command or request.data[:2] != command:
        return False
    message = R_SDK.decode(request).message
    return not isinstance(message, gimbal.PushSettings) or message.switch == gimbal.Switch.ON
