"""Which key asks for what, and how the bytes of a terminal become keys.

A terminal tells of presses and never of releases, so no key can be held: keys move an axis on by steps. The space bar
is STOP wherever it comes, in the middle of a sequence too: nothing typed before it may swallow it. What a drone
is told is a whole word and Enter, so that no slip of a finger starts a motor.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from teleop.config.device_commands import DRONE, DRONE_COMMANDS
from teleop.core.axes import Axis
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command, Press

STOP = " "
INVITE = "o"
"""Shows how others open the console beside a run."""
ESCAPE = "\x1b"


class JogStep(NamedTuple):
    """An axis moved on by so many units."""

    axis: Axis
    units: float


Act = Press | JogStep

ARROWS = {"A": (Axis.TILT, 1), "B": (Axis.TILT, -1), "C": (Axis.PAN, 1), "D": (Axis.PAN, -1)}
JOG, COARSE, FINE = 1.0, 10.0, 0.1  # deg of a step by an arrow, and how many of them with shift and with control
MODIFIED = {2: COARSE, 5: FINE}  # xterm's shift and control
_LETTERS = {"k": "A", "j": "B", "l": "C", "h": "D"}  # fine, or with shift coarse, where a terminal keeps such arrows
FOLLOW_MODES: Mapping[str, str] = {"l": "lock", "y": "yaw", "s": "sport"}

KEYS: Mapping[str, Act] = {
    STOP: Press(Command.STOP),
    "c": Press(Command.CLEAR),
    "e": Press(Command.ENABLE),
    "-": Press(Command.SLOWER),
    "+": Press(Command.FASTER),
    "=": Press(Command.FASTER),
    "v": Press(Command.RANGE),
    "z": Press(Command.RECENTER),
    "r": Press(Command.RECORD),
    ".": Press(Command.SHUTTER),
    "b": Press(Command.DISENGAGE),
    "q": Press(Command.QUIT),
    "[": JogStep(Axis.FOCUS, -0.01),
    "]": JogStep(Axis.FOCUS, 0.01),
    "{": JogStep(Axis.FOCUS, -0.1),
    "}": JogStep(Axis.FOCUS, 0.1),
    "<": JogStep(Axis.ROLL, -1.0),
    ">": JogStep(Axis.ROLL, 1.0),
    **{str(digit): Press(Command.RECALL, digit) for digit in range(10)},
    **{key: JogStep(ARROWS[arrow][0], 0.1 * ARROWS[arrow][1]) for key, arrow in _LETTERS.items()},
    **{key.upper(): JogStep(ARROWS[arrow][0], 10.0 * ARROWS[arrow][1]) for key, arrow in _LETTERS.items()},
}

PREFIXES: Mapping[str, tuple[str, Mapping[str, Act]]] = {
    "s": ("store which preset? 0-9", {str(digit): Press(Command.STORE, digit) for digit in range(10)}),
    "x": ("delete which preset? 0-9", {str(digit): Press(Command.DELETE, digit) for digit in range(10)}),
    "f": (
        "follow mode? l lock, y yaw, s sport",
        {
            key: Press(Command.TELL, device_command=DeviceCommand("gimbal", f"follow {mode}"))
            for key, mode in FOLLOW_MODES.items()
        },
    ),
    "a": (
        "follow which tracking source? 1-9, 0 ends",
        {str(digit): Press(Command.TELL, digit, DeviceCommand("track", str(digit))) for digit in range(10)},
    ),
}
"""Keys that ask for a second one: the question, and its answers. Any other key takes it back."""

SPELL, SPELLING = "d", "drone command: "
MARK, MARKING = "t", "mark target: "
TYPED = {SPELL: (SPELLING, "Enter sends"), MARK: (MARKING, "name,distance or name,x,y,z in m; Enter marks")}
"""Keys that are followed by a word: the question, and its hint."""

DRONE_WORDS: Mapping[str, Act] = {
    **{name: Press(Command.TELL, device_command=DeviceCommand(DRONE, name)) for name in DRONE_COMMANDS},
    "engage": Press(Command.ENGAGE),
    "disengage": Press(Command.DISENGAGE),
}
"""What can be spelled after the key that begins a word."""

HELP: Sequence[tuple[str, str]] = (
    ("space", "STOP all axes (motors stay on)"),
    ("c", "clear STOP"),
    ("arrows", "pan, tilt by 1 deg; shift 10, ctrl 0.1"),
    ("h j k l", "pan, tilt by 0.1 deg; H J K L by 10"),
    ("< >", "roll by 1 deg"),
    ("[ ]", "focus by 1 %; { } by 10 %"),
    ("- +  v", "speed range: slower, faster, next"),
    ("f l/y/s", "follow mode: lock, yaw, sport"),
    ("0-9", "recall preset"),
    ("s 0-9", "store preset"),
    ("x 0-9", "delete preset"),
    ("z", "recenter"),
    ("r", "record on or off"),
    (".", "shutter"),
    ("e", "manual on or off"),
    ("t word", "mark a target"),
    ("a 0-9", "follow a tracker"),
    ("d word", "drone: engage, arm"),
    ("b", "release the drone"),
    (INVITE, "console: QR code"),
    ("q", "quit"),
)

NO_EMERGENCY_STOP = "STOP is not an emergency stop: the motors stay powered."
LONGEST_WORD = 40

_SEQUENCE = re.compile(r"\x1b(?:O|\[(?P<parameters>[0-9;]*))(?P<final>[@-~])")
_BEGUN = re.compile(r"\x1b(?:O|\[[0-9;]*)?")


class KeyReader:
    """From what a terminal sends to what is asked for; `question` is what it waits to be answered, "" for nothing."""

    def __init__(self) -> None:
        self.question = ""
        self.helping = self.inviting = False
        self._answers: Mapping[str, Act] = {}
        self._word: str | None = None  # what has been typed of one
        self._typed_after = ""  # which key
        self._begun = ""  # of an escape sequence

    @property
    def is_waiting(self) -> bool:
        """Whether an escape sequence has begun: its rest comes at once or never."""
        return bool(self._begun)

    def settle(self) -> None:
        """The rest never came: it was the escape key, which takes a question back."""
        self._begun = ""
        self.inviting = False
        self._ask("")

    def feed(self, text: str) -> Iterator[Act]:
        text = self._begun + text
        self._begun = ""
        while text:
            if match := _SEQUENCE.match(text):
                self._ask("")
                yield from _arrow(match)
                text = text[match.end() :]
            elif _BEGUN.fullmatch(text):
                self._begun = text
                return
            elif begun := _BEGUN.match(text):  # and then comes what is no part of it
                self._ask("")
                text = text[begun.end() :]
            else:
                yield from self._key(text[0])
                text = text[1:]

    def _key(self, key: str) -> Iterator[Act]:
        if self._word is not None and key != STOP:
            yield from self._spell(self._word, key)
            return
        answers = self._answers
        asked = bool(answers)
        self._ask(key if key in PREFIXES and not (asked and key in answers) else "")
        if key == "?":
            self.helping = not self.helping
        elif key == INVITE and not asked:
            self.inviting = not self.inviting
        elif asked and key in answers:
            yield answers[key]
        elif not asked and key in TYPED:
            self._typed_after = key
            self._begin_word("")
        elif (not asked and key in KEYS) or key == STOP:
            yield KEYS[key]

    def _begin_word(self, word: str) -> None:
        question, hint = TYPED[self._typed_after]
        self._word, self.question = word, f"{question}{word}_   {hint}, Escape cancels"

    def _spell(self, word: str, key: str) -> Iterator[Act]:
        if key in "\r\n":
            self._ask("")
            if word and self._typed_after == MARK:
                yield Press(Command.TELL, device_command=DeviceCommand("target", word))
            elif word in DRONE_WORDS:
                yield DRONE_WORDS[word]
            elif word:
                self.question = f"unknown command {word}; commands: {', '.join(DRONE_WORDS)}"
        elif key in "\b\x7f":
            self._begin_word(word[:-1])
        elif key.isascii() and key.isprintable() and len(word) < LONGEST_WORD:
            self._begin_word(word + key.lower())

    def _ask(self, key: str) -> None:
        self._word = None
        self.question, self._answers = PREFIXES.get(key, ("", {}))


def _arrow(match: re.Match[str]) -> Iterator[Act]:
    """What an arrow asks for: xterm says its modifier as the second parameter."""
    if match["final"] not in ARROWS:
        return
    axis, sign = ARROWS[match["final"]]
    modifier = (match["parameters"] or "").partition(";")[2]
    yield JogStep(axis, sign * MODIFIED.get(int(modifier), 1.0) if modifier.isdecimal() else float(sign))
