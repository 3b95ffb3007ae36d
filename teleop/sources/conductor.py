"""A sequence with a hand on it: pause, resume, faster, slower, from key to key, while it plays.

The keys only ask; what becomes of it, and when, is the playback's. Leaving is not among them: Ctrl-C stops a sequence
as it stops everything.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from teleop.motion import Act, Demand, Motion
from teleop.sources.inputs import Command, Input, Press
from teleop.sources.sequence import SequenceSource

PACE = 0.1  # of the written speed, by which a key changes it
LOOK = 0.05  # s between two looks at the keys while nothing moves
PAUSE, SLOWER, FASTER = Press(Command.STOP), Press(Command.SLOWER), Press(Command.FASTER)
NEXT, PREVIOUS = Press(Command.RECALL, 1), Press(Command.RECALL, -1)  # the keyframes are the presets of a sequence
HELP = "space pause  - + speed  < > key  Ctrl-C stop"


class Conductor:
    """`sequence` under `keys`, an input whose presses count and nothing else of it."""

    def __init__(self, sequence: SequenceSource, keys: Input) -> None:
        self._sequence, self._keys = sequence, keys
        self._note = ""
        self._asked: Mapping[Press, Callable[[float], None]] = {
            PAUSE: self._pause,
            SLOWER: lambda now: self._change_speed(-PACE, now),
            FASTER: lambda now: self._change_speed(PACE, now),
            NEXT: lambda now: sequence.playback.step(1, now),
            PREVIOUS: lambda now: sequence.playback.step(-1, now),
        }

    @property
    def note(self) -> str:
        """What the operator is to know now, in a line."""
        playback = self._sequence.playback
        pace = "paused" if playback.paused else f"{playback.chosen:.0%}"
        return playback.refusal or self._note or f"{pace}  {HELP}"

    def start(self, now: float, motion: Motion) -> None:
        self._sequence.start(now, motion)

    def read(self, now: float) -> tuple[Demand, Sequence[Act]]:
        for press in self._keys.read(now).presses:
            self._note = "" if now >= self._sequence.begin else "the move has not begun"
            if not self._note:
                self._asked[press](now)
        return self._sequence.read(now)

    def next_change(self, now: float) -> float:
        change = self._sequence.next_change(now)
        return change if math.isinf(change) else min(change, now + LOOK)

    def _pause(self, now: float) -> None:
        playback = self._sequence.playback
        (playback.resume if playback.paused else playback.pause)(now)

    def _change_speed(self, share: float, now: float) -> None:
        playback = self._sequence.playback
        faster = max(PACE, round(playback.chosen / PACE) * PACE + share)
        playback.speed(min(faster, playback.at_most) if faster > playback.chosen else faster, now)


class PlayKeys:
    """From what a terminal sends to what is asked of a sequence; the shape that `Keyboard` wants of its reader."""

    question = ""
    helping = False

    def __init__(self) -> None:
        self._begun = ""

    @property
    def is_waiting(self) -> bool:
        return bool(self._begun)

    def settle(self) -> None:
        self._begun = ""

    def feed(self, text: str) -> Iterator[Press]:
        text = self._begun + text
        self._begun = ""
        while text:
            key = next((key for key in KEYS if text.startswith(key)), "")
            if not key and any(known.startswith(text) for known in KEYS):
                self._begun = text
                return
            if key:
                yield KEYS[key]
            text = text[len(key) or 1 :]


KEYS: Mapping[str, Press] = {
    " ": PAUSE,
    "p": PAUSE,
    "-": SLOWER,
    "+": FASTER,
    "=": FASTER,
    ">": NEXT,
    "<": PREVIOUS,
    "\x1b[C": NEXT,
    "\x1b[D": PREVIOUS,
    "\x1bOC": NEXT,
    "\x1bOD": PREVIOUS,
}
