"""What an operator sees of a commissioning and the keys that go with it, for a terminal and for a web page alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from teleop.commission.findings import Fact

GO, STOP, SKIP, REPEAT, END = "enter", "space", "s", "r", "q"
LEFT, RIGHT, UP, DOWN, RUBOUT = "left", "right", "up", "down", "backspace"
"""The keys by name; any other is the character itself."""


class Stage(StrEnum):
    """Where a commissioning is."""

    PROMPT = "prompt"  # what will happen: waits for Enter
    RUNNING = "running"
    ASKING = "asking"  # waits for an answer, in the middle of a step
    RELEASING = "releasing"  # everything is brought to rest
    SHOWN = "shown"  # what was found, or why there is nothing
    RESTORING = "restoring"  # the axes go to where they began
    LOST = "lost"  # the link is lost, and is tried again
    OVER = "over"


@dataclass(frozen=True)
class Page:
    """One screen. `lines` are what will happen, or what was asked and found; `keys` what each key does on this page.

    `typed` is what has been typed of a word, None where no word is asked for. `trouble` is why the step ended early.
    """

    key: str
    number: int
    total: int
    title: str
    stage: Stage
    lines: Sequence[str] = ()
    consent: str = ""
    question: str = ""
    typed: str | None = None
    progress: str = ""
    trouble: str = ""
    facts: Sequence[Fact] = ()
    keys: Mapping[str, str] = field(default_factory=dict)
    displaced: str = ""
