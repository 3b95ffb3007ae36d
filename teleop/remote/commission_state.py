"""The page of a commissioning as plain values: what a screen far away draws, and numbers what is pressed by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from teleop.commission.changes import written
from teleop.commission.findings import Fact, Findings
from teleop.commission.outline import Entry, outline
from teleop.commission.page import Page
from teleop.commission.runner import Runner

LONGEST = 300  # characters of a text: a state has a fixed room
MOST_FACTS, MOST_LINES = 40, 24


class CommissionState:
    """Makes the state of `runner`. `number` is that of the page, another one after each change of what a key does."""

    def __init__(self, runner: Runner, device: str) -> None:
        self._runner, self._device = runner, device
        self.number = 1
        self.files: Sequence[str] | None = None  # of the results, once they are written
        self.ending: Sequence[str] = ()  # what there is to say at the end
        self._shown: tuple[object, ...] = ()
        self._outlined: tuple[Findings, int] | None = None
        self._outline: Sequence[Mapping[str, str]] = ()

    def turn_over(self) -> None:
        """Whatever is pressed on the page as it was counts no longer."""
        self.number += 1

    def look(self) -> Page:
        """The page as it is now; a new one gets a new number."""
        page = self._runner.page
        # The text of a question may change with each reading, and its keys go on meaning the same.
        asked = "".join(letter for letter in page.question if not letter.isdigit() and letter not in "+-.")
        shown = page.key, page.stage, tuple(page.keys.items()), asked, page.trouble
        if shown != self._shown:
            self._shown = shown
            self.turn_over()
        return page

    def state(self) -> Mapping[str, Any]:
        page, runner = self.look(), self._runner
        return {
            "page": self.number,
            "device": self._device,
            "key": page.key,
            "step": page.number,
            "steps": page.total,
            "title": page.title[:LONGEST],
            "stage": page.stage.value,
            "lines": [line[:LONGEST] for line in self._lines(page)],
            "consent": page.consent[:LONGEST],
            "question": page.question[:LONGEST],
            "typed": page.typed,
            "progress": page.progress[:LONGEST],
            "trouble": page.trouble[:LONGEST],
            "facts": [_fact(fact) for fact in page.facts[:MOST_FACTS]],
            "keys": [[key, does] for key, does in page.keys.items()],
            "displaced": page.displaced,
            "moves": runner.moves,
            "reason": runner.reason[:LONGEST],
            "outline": self._entries(),
            "files": None if self.files is None else list(self.files),
        }

    def _lines(self, page: Page) -> Sequence[str]:
        return (self.ending if self._runner.over else page.lines)[:MOST_LINES]

    def _entries(self) -> Sequence[Mapping[str, str]]:
        """Made once for each change: there are 30 steps, and 100 states a second."""
        runner = self._runner
        now = runner.findings, len(runner.steps) if runner.over else runner.index
        if self._outlined is None or now[0] is not self._outlined[0] or now[1] != self._outlined[1]:
            self._outlined = now
            self._outline = [_entry(each) for each in outline(runner.steps, *now)]
        return self._outline


def _entry(entry: Entry) -> Mapping[str, str]:
    return {"key": entry.key, "title": entry.title, "result": entry.result.value}


def _fact(fact: Fact) -> Mapping[str, str]:
    """As people read it."""
    return {
        "key": fact.key,
        "title": fact.title[:LONGEST],
        "documented": written(fact.documented, fact.unit)[:LONGEST],
        "found": written(fact.found, fact.unit)[:LONGEST],
        "verdict": fact.verdict.value,
        "how": fact.how[:LONGEST],
    }
