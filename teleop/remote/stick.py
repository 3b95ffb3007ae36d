"""The stick of whoever has control over the network, as an input of the operator, with its dead man.

A stick is a stream of messages with a number and the sender's time. Their age is what counts, not that a connection is
there: TCP delivers a backlog in a burst, and a ping is answered while the script that reads the finger hangs. The age
is that of the sender's clock, which is known but for a constant: the quickest message so far tells it.

Silence after a message with every axis at 0 is a stick that was released. Any other silence is a hand that is lost.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from teleop.core.axes import Axis
from teleop.core.operator_input import Held

RAMP = 0.25  # s from which on its axes come to rest
DISARM = 1.0  # s from which on it has to take control again
TOO_LATE = 0.2  # s behind the quickest message: dropped
DRIFT = 2e-4  # s of that per s: two clocks drift apart, and the quickest message of an hour ago tells nothing
SESSIONS = 32  # whose sticks are remembered
TAKE = "take control"
AGAIN = "was not heard for too long: take control again"
CENTER = "center the stick"


@dataclass
class _Stream:
    """What one session has sent."""

    seq: int = -1
    quickest: float = math.inf  # arrival less the sender's time, s
    at: float = -math.inf  # when `quickest` was so
    sent: float = -math.inf  # of the newest message that counts, by our clock
    axes: Mapping[Axis, float] = field(default_factory=dict)
    missed: int = 0

    @property
    def deflected(self) -> bool:
        return any(self.axes.values())

    def age(self, now: float) -> float:
        return max(0.0, now - self.sent)

    def offset(self, now: float) -> float:
        """The least that arrival is behind the sender's time, as far as it is known now."""
        return self.quickest + DRIFT * (now - self.at) if math.isfinite(self.quickest) else math.inf


class RemoteStick:
    """`shape` makes a deflection as gentle as the rig's sticks are; `axes` are those that it may move.

    `name` is that of the one who has control. `missed` counts messages that were lost, late or out of order.
    """

    def __init__(self, axes: Collection[Axis], shape: Callable[[float], float]) -> None:
        self._axes, self._shape = axes, shape
        self.session = ""
        self._stream = _Stream()
        self._streams: dict[str, _Stream] = {}
        self._centered = self._lost = False
        self.name = "console"
        self.missed = 0
        self.waits_for = TAKE

    def give(self, session: str, name: str) -> None:
        """That session has control from now on, "" for none: its stick counts once it was seen centered."""
        self.session, self.name = session, name or "console"
        self._stream = self._streams.get(session) or _Stream()
        self._stream.quickest = math.inf  # its clock may have been set since
        self._lost = False
        self._centered = not self._stream.deflected

    def forget(self, session: str) -> None:
        """That session is gone; one that has control is lost."""
        self._streams.pop(session, None)
        self._lost = self._lost or session == self.session

    def take(self, session: str, fields: Mapping[str, Any], sent: float, now: float) -> None:
        """A message of a stick that arrives at `now`, and was sent at `sent` by the sender's clock, in s."""
        stream = self._streams.setdefault(session, _Stream())
        while len(self._streams) > SESSIONS:
            self._streams.pop(next(iter(self._streams)))
        if session == self.session:
            self._stream = stream
        seq = fields["seq"]
        if seq <= stream.seq:
            self._miss(session, 1)
            return
        gap = seq - stream.seq - 1 if stream.seq >= 0 else 0
        offset = now - sent
        late = offset - stream.offset(now)
        silent = stream.age(now) > RAMP and math.isfinite(stream.sent)
        self._miss(session, gap + (late > TOO_LATE))
        stream.seq = seq
        if session == self.session and silent and gap:
            self._lost = True
        if late > TOO_LATE:
            return
        if late < 0:
            stream.quickest, stream.at = offset, now
        stream.sent = sent + stream.offset(now)
        held = fields.get("hold", True)
        stream.axes = {axis: value for axis, value in fields["axes"].items() if held and axis in self._axes}
        if session == self.session and not stream.deflected:
            self._centered = True

    def _miss(self, session: str, count: int) -> None:
        if session == self.session:
            self.missed += count

    def age(self, now: float) -> float | None:
        """Of what the finger was last known to do, in s; None while it is up."""
        return self._stream.age(now) if self.session and self._stream.deflected else None

    @property
    def armed(self) -> bool:
        return not self.waits_for

    def read(self, now: float) -> Held:
        age = self.age(now)
        if self.session and age is not None and age > DISARM:
            self._lost = True
        self.waits_for = self._missing()
        if self.session and self._lost:
            return Held(trouble=f"{self.name} {AGAIN}", deflected=True)
        if self.waits_for:
            return Held()
        if age is not None and age > RAMP:
            return Held(late=f"was not heard for {RAMP:g} s", deflected=True)
        return Held({axis: self._shape(value) for axis, value in self._stream.axes.items()})

    def _missing(self) -> str:
        if not self.session:
            return TAKE
        if self._lost:
            return AGAIN
        return "" if self._centered else CENTER
