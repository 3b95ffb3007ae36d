"""What an operator is to know: the state of a run by hand, and in a line each what is stopping what, newest first."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from teleop.core.axes import Axis
from teleop.manual.interlock import Interlock

KEPT = 20  # messages


class Message(NamedTuple):
    """A line for the operator, and its time on the loop's clock."""

    time: float
    text: str


class InputStatus(NamedTuple):
    """An input: the axes that it moves now, and what it waits for before it may move any, "" when it may."""

    name: str
    moves: Sequence[Axis]
    waits_for: str
    trouble: str


@dataclass(frozen=True, slots=True)
class OperatorStatus:
    """The operator's side of a tick.

    `range` is the index of the speed range in force among `ranges`, `deflections` (-1..1) is what came of all sticks,
    `recall` what the axes are being taken to, "" for nothing, and `recall_end` when they are to be there. `recording`
    is whether the camera has confirmed that it records, `follow` the gimbal's follow mode that it last confirmed, ""
    for none. `presets` are the names of those stored, "" for one that has none.
    """

    inputs: Sequence[InputStatus]
    ranges: Sequence[float]
    range: int
    stopped: bool
    manual_control: bool
    recall: str
    recall_end: float
    recording: bool
    follow: str
    deflections: Mapping[Axis, float]
    presets: Mapping[int, str]
    messages: Sequence[Message]


def without_hands(
    inputs: Sequence[InputStatus], stopped: bool, recording: bool, messages: Sequence[Message]
) -> OperatorStatus:
    """Of a run that no hand moves: a STOP, what the camera does, and what was said."""
    facts = False, "", 0.0, recording, "", {}, {}
    return OperatorStatus(inputs, (1.0,), 0, stopped, *facts, messages)


class MessageLog:
    """The messages, and the last one about each input, so that none comes twice."""

    def __init__(self) -> None:
        self.messages: tuple[Message, ...] = ()
        self._kept: deque[Message] = deque(maxlen=KEPT)
        self._troubles: dict[Interlock, str] = {}
        self._hinted: set[Interlock] = set()

    def notify(self, now: float, text: str) -> None:
        if self._kept and self._kept[0].text == text:
            self._kept.popleft()
        self._kept.appendleft(Message(now, text))
        self.messages = tuple(self._kept)

    def begin(self, now: float) -> None:
        """The run begins: what was said before it has this time."""
        before = [message if message.time > -math.inf else message._replace(time=now) for message in self._kept]
        self._kept.clear()
        self._kept.extend(before)
        self.messages = tuple(self._kept)

    def changes(self, locks: Sequence[Interlock], drivers: Mapping[Axis, Interlock]) -> Iterator[str]:
        """A line for each input whose state has changed; `drivers` are those that moved an axis until now."""
        for lock in locks:
            trouble, before = lock.held.trouble, self._troubles.get(lock, "")
            self._troubles[lock] = trouble
            if trouble and trouble != before:
                stops = [axis.value for axis, driver in drivers.items() if driver is lock]
                yield f"{trouble}: {' and '.join(stops)} stopped" if stops else trouble
            elif before and not trouble:
                yield f"{lock.name}: {lock.waits_for or 'ready'}"
            if lock.unlocked:
                self._hinted.discard(lock)
            elif not trouble and lock not in self._hinted and any(lock.held.deflections.values()):
                self._hinted.add(lock)
                yield f"{lock.name} is locked: {lock.waits_for}"
