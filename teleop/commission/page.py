"""What an operator sees of a commissioning and the keys that go with it, for a terminal and for a web page alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from teleop.commission.findings import Fact
from teleop.commission.step import Question

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


def keys_on(stage: Stage, question: Question | None, in_trouble: bool) -> dict[str, str]:
    """What each key does on a page."""
    match stage:
        case Stage.PROMPT:
            return {GO: "goes", SKIP: "skips", END: "ends"}
        case Stage.RUNNING | Stage.RESTORING:
            return {STOP: "STOP", END: "ends"}
        case Stage.ASKING if question is not None:
            own = {GO: "answers"} if question.word else {END: "ends", **question.choices}
            return {**question.choices, **own, STOP: "STOP"}
        case Stage.SHOWN if in_trouble:
            return {REPEAT: "repeats", SKIP: "skips", END: "ends"}
        case Stage.SHOWN:
            return {GO: "next", REPEAT: "repeats", END: "ends"}
        case Stage.LOST:
            return {END: "ends"}
    return {}
