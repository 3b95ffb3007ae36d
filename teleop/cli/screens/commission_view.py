"""The screen of `teleop commission`: a page at a time, on any size of terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Callable

from rich.text import Text

from teleop.cli.screens.page_view import PageView
from teleop.cli.screens.picture import Rows, Sheet
from teleop.commission.changes import written
from teleop.commission.findings import Fact, Verdict
from teleop.commission.page import Page, Stage

_TITLE = 46  # cells of what a fact is about
_VALUE = 14  # and of its value
_STYLES = {Verdict.DOCUMENTED: "green", Verdict.DIFFERENT: "yellow", Verdict.NOT_SEEN: "dim"}
_UNBROKEN = "\u00a0"  # a space at which no line ends: between a key and what it does
_KEYS = {"enter": "Enter", "space": "space"}


class CommissionView(PageView):
    """Shows the page while it is entered: on a terminal a screen, elsewhere what is asked and found as lines.

    `beside` is a line on who else sees it.
    """

    def __init__(
        self, rig: str, page: Callable[[], Page], beside: Callable[[], str] = str, sheet: Sheet | None = None
    ) -> None:
        super().__init__(self._draw, sheet)
        self._rig, self._page, self._beside = rig, page, beside
        self._said = ""
        self._shown = page()

    def notify(self, text: str) -> None:
        """A line about a signal: it must not wait."""
        if not self._picture.possible:
            self._lines.notify(text)

    def update(self) -> None:
        """Take the page as it is now, from the thread that turns the runner."""
        self._shown = page = self._page()
        if self._picture.possible:
            return
        said = f"{page.key} {page.stage} {page.question}"
        if said != self._said:
            self._said = said
            for line in _in_lines(page):
                self._lines.notify(line)

    def _draw(self, width: int, height: int) -> Rows:  # noqa: ARG002 - Rows fit themselves in height
        page = self._shown
        place = f"step {page.number} of {page.total}"
        title = f" {self._rig}: {page.title}"[: max(0, width - len(place) - 2)]
        state: list[Text] = []
        if page.stage is Stage.SHOWN:
            state = [row for fact in page.facts for row in _fact_rows(fact, width)]
            if page.displaced:
                state.append(Text(f" It goes back to where it began: {page.displaced}", "yellow"))
        elif page.progress:
            state = [Text(f" {page.progress}", "cyan")]
        trouble = _wrapped(page.trouble, width)
        return Rows(
            title=Text(title.ljust(width - len(place) - 1) + place, "reverse"),
            banner=Text(f" {trouble[0]}", "bold red") if trouble else Text(),
            axes=[*(Text(f" {line}", "bold red") for line in trouble[1:]), Text(), *_head(page, width), Text()],
            state=state,
            notes=[Text(f" {line}", "dim") for line in _wrapped(self._beside(), width)],
            bottom=[
                Text(f" {line}", "bold" if page.question else "")
                for text in _bottom(page)
                for line in _wrapped(text, width)
            ],
        )


def _wrapped(text: str, width: int) -> list[str]:
    """In lines that leave a cell free on either side; the space in front of the first stays."""
    space = " " * (len(text) - len(text.lstrip(" ")))
    lines = textwrap.wrap(text.strip(), max(10, width - 2), initial_indent=space, subsequent_indent=space)
    return [line.replace(_UNBROKEN, " ") for line in lines]


def _head(page: Page, width: int) -> list[Text]:
    if page.stage is Stage.SHOWN and not page.trouble:
        return [Text(" Found:", "bold")]
    style = "" if page.stage is Stage.PROMPT else "dim"
    lines = [Text(f" {line}", style) for text in page.lines for line in _wrapped(text, width)]
    return [*lines, *(Text(f" {line}", "yellow") for line in _wrapped(page.consent, width))]


def _bottom(page: Page) -> list[str]:
    keys = "   ".join(
        f"{_KEYS.get(key, key)}{_UNBROKEN}{does.replace(' ', _UNBROKEN)}" for key, does in page.keys.items()
    )
    asked = [] if not page.question else [page.question]
    typed = [f"> {page.typed}_"] if page.typed is not None else []
    match page.stage:
        case Stage.RUNNING | Stage.RESTORING:
            keys = "space is STOP"
        case Stage.RELEASING:
            keys = "coming to rest"
    return [*asked, *typed, keys]


def _fact_rows(fact: Fact, width: int) -> list[Text]:
    """A line; a value that is too long for its column has lines of its own."""
    value = written(fact.found, fact.unit)
    below = [Text(f" {line}") for line in _wrapped(f"  {value}", width)] if len(value) > _VALUE else []
    row = Text(f" {fact.title[:_TITLE]:<{_TITLE}} {'' if below else value:<{_VALUE}} ")
    row.append(fact.verdict, _STYLES[fact.verdict])
    return [row, *below]


def _in_lines(page: Page) -> list[str]:
    """The page where there is no screen."""
    if page.stage is Stage.SHOWN:
        return (
            [page.trouble]
            if page.trouble
            else [f"{fact.title}: {written(fact.found, fact.unit)}" for fact in page.facts]
        )
    bottom = [line.replace(_UNBROKEN, " ") for line in _bottom(page)]
    if page.stage is Stage.PROMPT:
        return [page.title, *page.lines, *filter(None, [page.consent]), *bottom]
    return bottom if page.question else [page.trouble] if page.trouble else []
