"""A sequence with a hand on it: pause, resume, faster, slower, from key to key, go, and stop, while it plays.

The keys only ask; what becomes of it, and when, is the playback's. A stop ends the run, as fast as the axes may: off
the path there is nothing to go on with. The conductor also looks on as a sink, because only what is raised there ends
a run without losing a tick.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from teleop.motion import Act, Demand, Halt, Motion, Tick
from teleop.ports import Interrupted
from teleop.sources.inputs import Command, Input, Press
from teleop.sources.sequence import Phase, SequenceSource

PACE = 0.1  # of the written speed, by which a key changes it
LOOK = 0.05  # s between two looks at the keys while nothing moves
HELP = "space pause  - + speed  < > key  q stop"
ARMED_HELP = "enter starts it now  q stop"


class Conductor:
    """`sequence` under `keys`, an input whose presses count and nothing else of it."""

    def __init__(self, sequence: SequenceSource, keys: Input) -> None:
        self._sequence, self._keys = sequence, keys
        self._note = self._stopped = ""
        playback = sequence.playback
        self._asked: Mapping[Command, Callable[[float], None]] = {
            Command.PAUSE: self._pause,
            Command.SLOWER: lambda now: self._change_speed(-PACE, now),
            Command.FASTER: lambda now: self._change_speed(PACE, now),
            Command.NEXT: lambda now: playback.step(1, now),
            Command.PREVIOUS: lambda now: playback.step(-1, now),
        }

    @property
    def note(self) -> str:
        """What the operator is to know now, in a line."""
        if self._sequence.phase is Phase.ARMED:
            return ARMED_HELP
        playback = self._sequence.playback
        pace = "paused" if playback.paused else f"{playback.chosen:.0%}"
        return playback.refusal or self._note or f"{pace}  {HELP}"

    def start(self, now: float, motion: Motion) -> None:
        self._sequence.start(now, motion)

    def read(self, now: float) -> tuple[Demand, Sequence[Act]]:
        for press in self._keys.read(now).presses:
            self._obey(press, now)
        demand, acts = self._sequence.read(now)
        return (dict.fromkeys(demand, Halt()), ()) if self._stopped else (demand, acts)

    def next_change(self, now: float) -> float:
        change = self._sequence.next_change(now)
        return change if math.isinf(change) else min(change, now + LOOK)

    def write(self, tick: Tick) -> None:  # noqa: ARG002 - only whether the run is to end
        """Raises Interrupted once it has been stopped."""
        if self._stopped:
            raise Interrupted(self._stopped)

    def release(self, now: float) -> float | None:  # noqa: ARG002 - nothing was taken over
        return None

    def _obey(self, press: Press, now: float) -> None:
        self._note = ""
        if press.command is Command.QUIT:
            self._stopped = f"stopped by {self._keys.name}"
        elif press.command is Command.GO:
            self._sequence.go()
        elif self._sequence.phase is not Phase.PLAYING:
            self._note = "the move has not begun"
        elif press.command in self._asked:
            self._asked[press.command](now)

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
    " ": Press(Command.PAUSE),
    "p": Press(Command.PAUSE),
    "-": Press(Command.SLOWER),
    "+": Press(Command.FASTER),
    "=": Press(Command.FASTER),
    **dict.fromkeys((">", "\x1b[C", "\x1bOC"), Press(Command.NEXT)),
    **dict.fromkeys(("<", "\x1b[D", "\x1bOD"), Press(Command.PREVIOUS)),
    **dict.fromkeys(("\n", "\r", "g"), Press(Command.GO)),
    "q": Press(Command.QUIT),
}
