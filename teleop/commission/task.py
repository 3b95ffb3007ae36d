"""A step's script under way: what it waits for, and the word that is being typed for it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from teleop.commission.page import GO, RUBOUT
from teleop.commission.step import Question, Script

LONGEST_WORD = 40


@dataclass
class Task:
    """`wake` is when the script goes on, `question` what it waits for."""

    script: Script
    wake: float = -math.inf
    question: Question | None = None
    typed: str = ""
    progress: str = ""

    def go_on(self, answer: str | None, now: float) -> None:
        """Until it has to wait for a later turn; `answer` is that to its question. Raises what the script raises.

        Raises StopIteration, with the facts, at the script's end.
        """
        self.question = None
        while True:
            asked = next(self.script) if answer is None else self.script.send(answer)
            answer = None
            if isinstance(asked, Question):
                self.question = asked
                self.wake = math.inf if asked.seconds is None else now + asked.seconds
                return
            self.progress = asked.progress or self.progress
            if asked.seconds > 0:
                self.wake = now + asked.seconds
                return

    def type(self, key: str) -> str | None:
        """A key while a word is asked for: the word when Enter came, else None."""
        if key == GO:
            return self.typed.strip()
        if key == RUBOUT:
            self.typed = self.typed[:-1]
        elif len(key) == 1:
            self.typed = (self.typed + key)[:LONGEST_WORD]
        return None
