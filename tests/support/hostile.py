"""Adapters that lose, delay, duplicate, split and corrupt CAN frames.

Each takes one CAN frame's data and gives what the bus carries instead; `Hostile` puts them in front of any link.
"""

from collections.abc import Callable
from random import Random

from teleop.core.interfaces import Link
from teleop.dji.frame import pieces

Trick = Callable[[bytes, Random], list[bytes]]


def lose(piece: bytes, dice: Random) -> list[bytes]:
    return [] if dice.random() < 0.2 else [piece]


def duplicate(piece: bytes, dice: Random) -> list[bytes]:
    return [piece] * (2 if dice.random() < 0.2 else 1)


def split(piece: bytes, dice: Random) -> list[bytes]:
    cut = dice.randrange(len(piece) + 1)
    return [part for part in (piece[:cut], piece[cut:]) if part]


def corrupt(piece: bytes, dice: Random) -> list[bytes]:
    at = dice.randrange(len(piece))
    flipped = piece[at] ^ (1 << dice.randrange(8) if dice.random() < 0.2 else 0)
    return [piece[:at] + bytes([flipped]) + piece[at + 1 :]]


class Delay:
    """Lets a CAN frame through only after the ones behind it."""

    def __init__(self) -> None:
        self._held: list[bytes] = []

    def __call__(self, piece: bytes, dice: Random) -> list[bytes]:
        if dice.random() < 0.2:
            self._held.append(piece)
            return []
        late, self._held = self._held, []
        return [piece, *late]


TRICKS: dict[str, Callable[[], Trick]] = {
    "lose": lambda: lose,
    "duplicate": lambda: duplicate,
    "split": lambda: split,
    "corrupt": lambda: corrupt,
    "delay": Delay,
}


class Hostile:
    """The sending half of a link, one CAN frame at a time, with tricks played on each."""

    def __init__(self, link: Link, dice: Random, *names: str) -> None:
        self._link = link
        self._dice = dice
        self._tricks = [TRICKS[name]() for name in names]
        self.sent = 0  # bytes that reached the bus

    def send(self, frame: bytes) -> None:
        passing = pieces(frame)
        for trick in self._tricks:
            passing = [survivor for piece in passing for survivor in trick(piece, self._dice)]
        for piece in passing:
            self._link.send(piece)
            self.sent += len(piece)
