"""The screen of `teleop live --learn`: a question, or what each control does, on any size of terminal."""

from __future__ import annotations

from rich.text import Text

from teleop.app.learn.session import LearnSession, Stage
from teleop.app.learn.trial import Row, words
from teleop.cli.screens.page_view import PageView
from teleop.cli.screens.picture import Rows
from teleop.config.inputs_section import ControlSection

_SKIPS = "Enter skips"
_WIDEST = 28  # cells of a control's name
_LONGEST = 50  # cells of a path
_DOES = 30  # cells of what it does


class LearnView(PageView):
    """Shows the session while it is entered: on a terminal a screen, elsewhere each question as a line."""

    def __init__(self, session: LearnSession) -> None:
        super().__init__(self._draw)
        self._session = session
        self._line = ""

    def update(self) -> None:
        """Print what is asked, where there is no screen."""
        line = f"{self._headline}{f' ({self._status})' if self._status else ''}"
        if not self._picture.possible and line != self._line:
            self._line = line
            self._lines.notify(line)

    @property
    def _headline(self) -> str:
        session = self._session
        match session.stage:
            case Stage.QUESTIONS:
                page = session.dialogue.page
                return f"{page.text}; {_SKIPS}" if session.dialogue.may_skip else page.text
            case Stage.CONFIRM:
                return f"{_short(str(session.target.file))} exists: y overwrites it"
        return "Try every control. Nothing moves. Enter accepts, q leaves without writing"

    @property
    def _status(self) -> str:
        session = self._session
        return session.dialogue.page.status if session.stage is Stage.QUESTIONS else session.problem.partition("\n")[0]

    def _draw(self, width: int, height: int) -> Rows:
        session = self._session
        asking = session.stage is Stage.QUESTIONS
        page = session.dialogue.page
        place = f"question {page.number} of {page.total}" if asking else "trial"
        title = f" Learn the controls of {session.devices.names}"[: max(0, width - len(place) - 3)]
        head = [Text(), Text(f" {self._headline}", "bold"), Text(f" {self._status}", "yellow"), Text()]
        room = max(1, height - len(head) - 7)
        notes = [Text(f" {note}", "yellow") for note in self._notes()]
        rows = self._learned(room) if asking else self._tried(room - len(notes))
        return Rows(
            title=Text(title.ljust(width - len(place) - 1) + place, "reverse"),
            axes=head,
            state=rows,
            notes=notes,
            bottom=[Text(f" {line}", "dim") for line in self._keys()],
        )

    def _notes(self) -> list[str]:
        session = self._session
        if session.stage is Stage.QUESTIONS:
            return list(session.devices.notes(session.now()))
        return list(session.trial.notes) if session.trial else []

    def _keys(self) -> list[str]:
        session = self._session
        if session.stage is Stage.CONFIRM:
            return ["y overwrites   n goes back   q leaves without writing"]
        if session.stage is Stage.QUESTIONS:
            return [f"{_SKIPS}   b asks the one before again   t tries what was learned", "q leaves without writing"]
        again = session.again
        repeat = f"r asks again: {again.text}" if again else ""
        return [f"Enter {self._accepts}", repeat, "q leaves without writing"]

    @property
    def _accepts(self) -> str:
        target = self._session.target
        if target.file is None:
            return "prints the inputs (-o FILE writes a profile)"
        return f"{'updates' if target.updates else 'writes'} {_short(str(target.file))}"

    def _learned(self, room: int) -> list[Text]:
        """The latest answers."""
        rows = []
        for answer in self._session.answers.given:
            does = words(ControlSection.model_validate(answer.action)) if answer.action else "enable"
            rows.append(Text(f"  {answer.found.name:<{_WIDEST}} {does}"))
        return rows[-room:]

    def _tried(self, room: int) -> list[Text]:
        """Each control of the trial; of many those around the one moved last."""
        session = self._session
        if session.trial is None:
            return []
        names, lines, at, before = session.trial.names, list[Text](), 0, -1
        for row in session.trial.rows:
            if len(names) > 1 and row.input != before:
                lines.append(Text(f" {names[row.input]}", "bold"))
            before, is_last = row.input, _same(row, session.last_moved)
            at = len(lines) if is_last else at
            lines.append(_row(row, is_last))
        first = max(0, min(at - room // 2, len(lines) - room))
        return lines[first : first + room]


def _short(path: str) -> str:
    """The end of a long path."""
    return path if len(path) <= _LONGEST else f"...{path[-_LONGEST:]}"


def _same(row: Row, other: Row | None) -> bool:
    return other is not None and (row.input, row.control) == (other.input, other.control)


def _row(row: Row, is_last: bool) -> Text:
    text = f" {'>' if is_last else ' '}{row.control:<{_WIDEST}} {row.does:<{_DOES}} {row.asks}"
    return Text(text, "bold" if row.is_active else "")
