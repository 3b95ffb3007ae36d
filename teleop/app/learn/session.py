"""`live --learn` from its first question to the profile that is written; nothing of the rig is opened.

The questions, then the trial of the answers, from which one of them may be asked again, then the file. Until the
operator accepts nothing is written; the file is then complete or as it was.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import Enum

from teleop.app.learn.answers import Answers
from teleop.app.learn.devices import LearnedDevices
from teleop.app.learn.dialogue import Dialogue
from teleop.app.learn.merge import entry_for
from teleop.app.learn.questions import Question, questions
from teleop.app.learn.target import Target
from teleop.app.learn.trial import Row, Trial
from teleop.config.documents.document import DocumentError
from teleop.config.files import OutputError, is_stream
from teleop.config.profile import Profile
from teleop.core.operator_input import Command
from teleop.inputs.hid.backend import HidBackend
from teleop.inputs.learn_keymap import ACCEPT, AGAIN, LEAVE, YES


class Stage(Enum):
    """Where it is; the last three are its ends."""

    QUESTIONS = "questions"
    TRIAL = "trial"
    CONFIRM = "confirm"  # that another file is written over
    WRITTEN = "written"
    OUTPUT = "output"  # `output` is for the caller to print
    LEFT = "left"


OVER = (Stage.WRITTEN, Stage.OUTPUT, Stage.LEFT)


class LearnSession:
    """Open while it is entered. `polled`: on the virtual clock. Raises UsageError without a device to learn."""

    def __init__(
        self, profile: Profile, target: Target, backend: HidBackend, now: Callable[[], float], polled: bool = False
    ) -> None:
        self.profile, self.target = profile, target
        self._backend, self.now, self._polled = backend, now, polled
        self.devices = LearnedDevices(profile, backend, now, polled)
        self.answers = Answers()
        has_gimbal = any(section.type == "gimbal" for section in profile.sinks)
        self.questions = questions(profile.axes, has_gimbal, bool(profile.drones))
        self.dialogue = Dialogue(self.questions, self.devices, self.answers, self._enable_buttons())
        self.trial: Trial | None = None
        self.stage = Stage.QUESTIONS
        self.problem = ""  # why it cannot be accepted, or was not written
        self.output = ""
        self.last_moved: Row | None = None

    def __enter__(self) -> LearnSession:
        self.devices.open()
        return self

    def __exit__(self, *_: object) -> None:
        self._close_trial()
        self.devices.close()

    @property
    def over(self) -> bool:
        return self.stage in OVER

    def turn(self, now: float, keys: Sequence[Command]) -> None:
        """Look at devices and keys. Raises DeviceError when a device that is needed is unplugged."""
        if LEAVE in keys:
            self.stage = Stage.LEFT
        elif self.stage is Stage.QUESTIONS:
            self.dialogue.turn(now, keys)
            if self.dialogue.over:
                self._try()
        else:
            self._look(now)
            for key in keys:
                self._press(key)

    @property
    def again(self) -> Question | None:
        """The question that is asked again when that is asked for: that of the control moved last."""
        row = self.last_moved
        if row is None:
            return self.answers.given[-1].question if self.answers.given else None
        for question in self.questions:
            action = {} if row.action is None else row.action.model_dump(mode="json")
            if question.enable if row.action is None else question.is_answered_by(action):
                return question
        return None

    def _press(self, key: Command) -> None:
        if self.stage is Stage.CONFIRM:
            self.stage = Stage.TRIAL
            if key is YES:
                self._write()
        elif key is ACCEPT and self.trial is not None:
            if self.target.replaces:
                self.stage = Stage.CONFIRM
            else:
                self._write()
        elif key is AGAIN and (question := self.again):
            self._close_trial()
            self.devices.open()
            self.dialogue.repeat(question)
            self.stage = Stage.QUESTIONS

    def _look(self, now: float) -> None:
        if self.trial is None:
            return
        before = {(row.input, row.control) for row in self.trial.rows if row.is_active}
        self.trial.read(now)
        begun = (row for row in self.trial.rows if row.is_active and (row.input, row.control) not in before)
        self.last_moved = next(begun, self.last_moved)

    def _try(self) -> None:
        """Leave the questions for the trial of what was learned; without an answer there is nothing to try."""
        self.devices.close()
        self.stage, self.problem, self.last_moved = Stage.TRIAL, "", None
        if not self.answers.given:
            self.stage = Stage.LEFT
            return
        try:
            profile = self.target.profile(self.answers, self.devices)
        except (DocumentError, OutputError) as error:
            self.problem = str(error)
            return
        self.trial = Trial(profile, self._backend, self.now, self._polled)
        self.trial.__enter__()

    def _close_trial(self) -> None:
        if self.trial is not None:
            self.trial.__exit__()
            self.trial = None

    def _write(self) -> None:
        """As the file is by now, if it has been changed meanwhile."""
        try:
            if self.target.file is None:
                self.output, self.stage = self.target.lines(self.answers, self.devices), Stage.OUTPUT
                return
            text = self.target.text(self.answers, self.devices)
            if is_stream(self.target.file):
                self.output, self.stage = text, Stage.OUTPUT
                return
            self.target.write(text)
            self.stage = Stage.WRITTEN
        except (DocumentError, OutputError) as error:
            self.problem = str(error)

    def _enable_buttons(self) -> Sequence[str | None]:
        """The enable button that the profile has for each device."""
        entries = [section.model_dump(mode="json", exclude_none=True) for section in self.profile.inputs]
        indexes = [entry_for(device.info, entries, set()) for device in self.devices.each]
        return [None if index is None else self.profile.inputs[index].enable for index in indexes]
