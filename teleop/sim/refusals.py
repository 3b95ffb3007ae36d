"""What a simulator did not obey, and why, so that the author of a client can see it.

Real devices are silent about most of it. Nothing here changes what a simulator does.
"""

from __future__ import annotations

from collections import Counter, deque
from enum import Enum
from typing import NamedTuple

from teleop.dji.frame import Damage
from teleop.dji.message import Message, Opaque

_KEPT = 256  # refusals that are not taken yet; the counts are of all


class Why(Enum):
    """The kinds of refusal."""

    DAMAGED = "damaged frame"
    UNKNOWN = "unknown command"
    LENGTH = "wrong length"
    RANGE = "out of range"
    NOT_ACTIVATED = "not activated"
    KEY = "wrong key"
    NO_CONTROL = "no control"
    MODE = "wrong mode"
    STATE = "not now"
    REPLY = "reply bit set"
    NOT_CAPTURED = "not in the capture"


class Refusal(NamedTuple):
    """At `time` (s) a `command` (`drone.move`, or set and id in hexadecimal) was not obeyed; `detail` may be empty."""

    time: float
    command: str
    why: Why
    detail: str


class Refusals:
    """All that one simulator refused: `counts` by command and reason."""

    def __init__(self) -> None:
        self.counts: Counter[tuple[str, Why]] = Counter()
        self._new: deque[Refusal] = deque(maxlen=_KEPT)

    @property
    def total(self) -> int:
        return self.counts.total()

    def add(self, time: float, command: str, why: Why, detail: str = "") -> None:
        self.counts[command, why] += 1
        self._new.append(Refusal(time, command, why, detail))

    def add_damage(self, time: float, damage: Damage) -> None:
        """Bytes that are no frame."""
        shown = damage.data[:24].hex() + ("..." if len(damage.data) > 24 else "")
        self.add(time, "bytes", Why.DAMAGED, f"{damage.reason}: {shown}")

    def take(self) -> list[Refusal]:
        """Those since the last call, at most the newest 256."""
        taken = list(self._new)
        self._new.clear()
        return taken


def command_name(message: Message) -> str:
    """How a refusal names what came: the message's name, or set and id where nothing is known of it."""
    return (
        message.name if not isinstance(message, Opaque) else f"0x{message.prefix.hex()}" if message.prefix else "data"
    )
