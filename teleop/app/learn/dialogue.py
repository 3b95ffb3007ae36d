"""The questions, one after the other: what is asked now, and which control answers.

Values in, values out: `turn` is called with the time and the keys that were pressed, and leaves a `Page` to show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from teleop.app.learn.answers import ONE_WAY, Answer, Answers, refusal
from teleop.app.learn.devices import LearnedDevices
from teleop.app.learn.questions import Question
from teleop.core.operator_input import Command
from teleop.inputs.hid.backend import identified
from teleop.inputs.hid.learn import Found, Kind

QUIET = 0.5  # s without a movement: everything has been let go
HELD = 2.0  # s: what is away from its rest for longer was put there, and is not merely held
SKIP, BACK, TRY = Command.GO, Command.PREVIOUS, Command.NEXT


class Step(Enum):
    """What the dialogue waits for."""

    RELEASE = "release"  # every control at rest
    MOVE = "move"  # the control that is meant
    SETTLE = "settle"  # that control let go


@dataclass(frozen=True)
class Page:
    """What is asked, what has been seen of the answer, and which question of how many it is."""

    text: str
    status: str
    number: int
    total: int


class Dialogue:
    """Asks the questions of these devices; `answers` has what came of them. `in_use` are enable buttons by device."""

    def __init__(
        self, questions: Sequence[Question], devices: LearnedDevices, answers: Answers, in_use: Sequence[str | None]
    ) -> None:
        self._questions, self._devices, self._answers, self._in_use = questions, devices, answers, in_use
        self._at = 0
        self._back = False  # the other direction of the axis is asked for
        self._once = False  # one question is repeated, and that is all
        self._step = Step.RELEASE
        self._found: tuple[int, Found] | None = None
        self._skips = False  # Enter was pressed while the control that was moved had yet to be released
        self._stays = False  # the control that was moved has not gone back
        self._status = ""
        self._resting = False
        self.over = False

    @property
    def page(self) -> Page:
        question = self._questions[min(self._at, len(self._questions) - 1)]
        text = question.back if self._back else question.text
        if self._step is Step.RELEASE and not self._found:
            text = "Release all controls"
        return Page(text, self._status, self._at + 1, len(self._questions))

    @property
    def asks(self) -> bool:
        """Whether a control is waited for."""
        return self._step is Step.MOVE

    @property
    def may_skip(self) -> bool:
        """Whether a question is on the page."""
        return self._step is not Step.RELEASE

    def repeat(self, question: Question) -> None:
        """Ask this question again, alone; what answered it before is forgotten."""
        self._answers.drop(question)
        self._go_to(self._questions.index(question))
        self._once = True

    def turn(self, now: float, keys: Sequence[Command]) -> None:
        """Look at the devices and at the keys. Raises DeviceError when a device that is needed is gone."""
        self._devices.poll(now)
        self._devices.check(self._answers.devices, now)
        for key in keys:
            self._press(key)
        if self.over:
            return
        if self._step is Step.MOVE:
            self._look(now)
        else:
            self._wait(now)

    def _press(self, key: Command) -> None:
        if key is TRY:
            self.over = bool(self._answers.given)
            self._status = "" if self.over else "Nothing is learned yet"
        elif key is SKIP and self._step is Step.MOVE:
            self._status = ""
            self._next()
        elif key is SKIP:
            self._skips = True
        elif key is BACK and not self._once:
            before = self._at if self._back else max(0, self._at - 1)
            self._answers.drop(self._questions[before])
            self._go_to(before)

    def _go_to(self, index: int) -> None:
        self._at, self._back, self._found, self._status = index, False, None, ""
        self._step, self._resting, self._stays, self._skips = Step.RELEASE, False, False, False
        self.over = False

    def _wait(self, now: float) -> None:
        """For everything to be let go."""
        if not self._resting:
            self._devices.rest(now)
            self._resting = True
        if not self._devices.rested(now, HELD if self._stays else QUIET):
            return
        self._resting = False
        if self._found is None:
            self._ask()
            return
        device, found = self._found
        if self._devices.each[device].was_released(found):
            self._refuse(f"{found.name} was held and is released now")
            return
        settled = self._devices.each[device].settled(found)
        if settled.kind is Kind.LEVER and not self._stays:
            self._stays = True  # it stays, or is held: looked at again after a while
            return
        self._answered(device, settled)

    def _ask(self) -> None:
        self._step, self._found, self._stays, self._skips = Step.MOVE, None, False, False
        for device in self._devices.each:
            device.watch(smooth=self._questions[self._at].moves)

    def _look(self, now: float) -> None:
        for index, device in enumerate(self._devices.each):
            if found := device.see(now):
                self._found, self._step = (index, found), Step.SETTLE
                self._status = f"{self._called(index, found)}: release it"
                return

    def _called(self, device: int, found: Found) -> str:
        """The control, with its device where there are several."""
        several = len(self._devices.each) > 1
        return f"{identified(self._devices.each[device].info)}: {found.name}" if several else found.name

    def _answered(self, device: int, found: Found) -> None:
        question = self._questions[self._at]
        if why := self._why_not(device, found):
            self._refuse(f"{why}: choose another")
            return
        learned = self._devices.each[device]
        self._answers.given.append(Answer(question, device, found, self._back, learned.known.get(found.name)))
        self._status = f"{self._called(device, found)}: learned"
        if found.kind in ONE_WAY and question.moves and not self._back:
            self._back = True
            self._ask()
        else:
            self._next()

    def _refuse(self, why: str) -> None:
        """Ask again, unless the question was to be skipped."""
        self._status = "" if self._skips else why
        if self._skips:
            self._next()
        else:
            self._ask()

    def _why_not(self, device: int, found: Found) -> str:
        question = self._questions[self._at]
        if self._answers.user_of(device, found.name) is not None:
            return f"{found.name} is already in use"
        asked_again = any(each.question.enable for each in self._answers.given)
        if not question.enable and found.name == self._in_use[device] and not asked_again:
            return f"{found.name} is the enable button"
        return refusal(question, found, self._devices.each[device].hats)

    def _next(self) -> None:
        self._back = False
        if self._once or self._at + 1 >= len(self._questions):
            self.over = True
            return
        self._at += 1
        self._ask()
