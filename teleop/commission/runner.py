"""Takes an operator through the steps, one page each: no terminal, no clock; keys and the time come in, pages go out.

Nothing moves without Enter on the page that says what will. Whatever ends a step (its end, space, a fault, a signal) is
followed by the release of the device until everything rests.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from teleop.commission.findings import Fact, Findings, Verdict
from teleop.commission.outline import SKIPPED
from teleop.commission.page import END, GO, REPEAT, SKIP, STOP, Page, Stage, keys_on
from teleop.commission.step import Device, Question, Step
from teleop.commission.task import Task
from teleop.core.errors import DeviceError, LinkError
from teleop.dji.message import FieldError

AUTOREPEAT = 0.045  # s between two Enters of a key that is held down: the second does not count
STALL = 0.5  # s between two turns: the computer was elsewhere, and what was sent has lapsed
RETRY = 1.0  # s between two attempts to open a lost link


class RefusedError(DeviceError):
    """The commissioning must not go on at all."""


class Runner:
    """`steps` in their order; `findings` grow. `final` steps are what an operator who ends early still comes to."""

    def __init__(
        self,
        device: Device,
        steps: Sequence[Step],
        findings: Findings,
        *,
        final: Sequence[Step] = (),
        on_facts: Callable[[Findings], object] = lambda _findings: None,
    ) -> None:
        self.findings = findings
        self.stage = Stage.PROMPT
        self.reason = ""  # why it ended otherwise than by its last step
        self._device, self._steps, self._first_final = device, [*steps, *final], len(steps)
        self._on_facts = on_facts
        self._index = -1
        self._task: Task | None = None
        self._facts: Sequence[Fact] = ()
        self._trouble = ""
        self._then: Callable[[float], None] = self._show  # after the release
        self._target: Callable[[float], None] = self._show  # after the way back
        self._last_enter = self._retry = -math.inf
        self._turned = math.inf
        self._release_at = -math.inf
        self._done_any = self._ending = False

    @property
    def over(self) -> bool:
        return self.stage is Stage.OVER

    @property
    def step(self) -> Step:
        return self._steps[max(0, self._index)]

    def turn(self, now: float, keys: Sequence[str] = ()) -> None:
        """Look at the device and the keys; call it every 10 ms. Raises nothing that the page cannot say."""
        late, self._turned = now - self._turned > STALL, now
        if self._index < 0:
            self._next(now)
        try:
            if self.stage is not Stage.LOST:
                self._device.poll(now)
            for key in keys:
                self._press(key, now)
            if late and self._moves:
                self._end_task("the computer stalled: nothing was measured")
            self._advance(now)
        except DeviceError as error:
            self._end_task(str(error))
        except LinkError as error:
            self._lose(str(error), now)

    def interrupt(self, reason: str) -> None:
        """End now, whatever is under way: everything is brought to rest, and nothing is sent back to its place."""
        self.reason = self.reason or reason
        self._end_task(reason, self._finish)

    def stop(self, reason: str) -> None:
        """End the step under way, as the key for it does; `reason` is what its page says."""
        if self._moves:
            self._end_task(reason)

    @property
    def steps(self) -> Sequence[Step]:
        return self._steps

    @property
    def index(self) -> int:
        """Of the step whose page it is, -1 before the first."""
        return self._index

    @property
    def moves(self) -> bool:
        """Whether a step acts now: not at a question that only waits for its answer, at which everything rests."""
        question = self._question
        waits = self.stage is Stage.ASKING and question is not None and question.only_waits
        return self._moves and not waits

    @property
    def asks_for_stop(self) -> bool:
        """Whether STOP is an answer to what is asked."""
        question = self._question
        return question is not None and STOP in question.choices

    @property
    def _question(self) -> Question | None:
        return None if self._task is None else self._task.question

    @property
    def _moves(self) -> bool:
        return self.stage in (Stage.RUNNING, Stage.ASKING, Stage.RESTORING)

    def _press(self, key: str, now: float) -> None:
        if key == GO:
            held = now - self._last_enter < AUTOREPEAT
            self._last_enter = now
            if held:
                return
        handlers = {
            Stage.PROMPT: self._at_prompt,
            Stage.RUNNING: self._while_running,
            Stage.RESTORING: self._while_running,
            Stage.ASKING: self._at_question,
            Stage.SHOWN: self._at_result,
            Stage.LOST: self._while_lost,
        }
        if handler := handlers.get(self.stage):
            handler(key, now)

    def _at_prompt(self, key: str, now: float) -> None:
        if key == GO:
            self._begin()
        elif key == SKIP:
            self._skip(now)
        elif key == END:
            self._leave(self._end, now)

    def _while_running(self, key: str, _now: float) -> None:
        if key == STOP:
            self._end_task("STOPPED")
        elif key == END:
            self._end_task("STOPPED", self._end_from)

    def _at_question(self, key: str, now: float) -> None:
        task, question = self._task, self._question
        if task is None or question is None:
            return
        if key == STOP and STOP not in question.choices:
            self._end_task("STOPPED")
        elif question.word:
            if (word := task.type(key)) is not None:
                self._answer(task, word, now)
        elif key in question.choices:
            self._answer(task, key, now)
        elif key == END:
            self._end_task("STOPPED", self._end_from)

    def _at_result(self, key: str, now: float) -> None:
        if key == END:
            self._leave(self._end, now)
        elif key == REPEAT or (key == GO and self._trouble):
            self._leave(self._prompt, now)
        elif key == SKIP and self._trouble:
            self._leave(self._skip, now)
        elif key == GO:
            self._leave(self._next, now)

    def _while_lost(self, key: str, now: float) -> None:
        if key == END:
            self.reason = self.reason or self._trouble
            self._finish(now)

    def _answer(self, task: Task, answer: str, now: float) -> None:
        task.typed = ""
        self._resume(task, answer, now)

    def _advance(self, now: float) -> None:
        task = self._task
        if self.stage is Stage.LOST:
            self._reopen(now)
        elif self.stage is Stage.RELEASING:
            self._release(now)
        elif task is not None and now >= task.wake - 1e-9:
            self._resume(task, None if task.question is None else "", now)

    def _resume(self, task: Task, answer: str | None, now: float) -> None:
        if answer is not None:
            self.stage = Stage.RUNNING
        try:
            task.go_on(answer, now)
            if task.question is not None:
                self.stage = Stage.ASKING
        except StopIteration as end:
            if self.stage is not Stage.RESTORING:
                self._found([replace(fact, step=self.step.key) for fact in end.value or ()])
            self._end_task("", self._show if self.stage is not Stage.RESTORING else self._target)
        except RefusedError as refusal:
            self.reason = str(refusal)
            self._end_task(self.reason, self._finish)
        except (DeviceError, FieldError) as error:
            self._end_task(str(error))

    def _found(self, facts: Sequence[Fact]) -> None:
        self._facts = facts
        self._done_any |= not self.step.automatic
        self.findings = self.findings.with_facts(facts)
        self._on_facts(self.findings)

    def _end_task(self, trouble: str, then: Callable[[float], None] | None = None) -> None:
        """Whatever is under way is over: everything is brought to rest, `then` goes on; by default the result."""
        if self._task is not None:
            self._task.script.close()
        self._task, self._trouble, self._then = None, trouble, then or self._show
        self._release_at = -math.inf
        self.stage = Stage.RELEASING

    def _release(self, now: float) -> None:
        if now < self._release_at - 1e-9:
            return
        after = self._device.release(now)
        if after is None:
            self._then(now)
        else:
            self._release_at = after

    def _show(self, now: float) -> None:
        self.stage = Stage.SHOWN
        expected = all(fact.verdict is not Verdict.DIFFERENT for fact in self._facts)
        nothing_to_read = not self.step.subjects or (self.step.automatic and expected)
        if nothing_to_read and not self._trouble:
            self._next(now)

    def _leave(self, target: Callable[[float], None], now: float) -> None:
        """Go on with `target`, once the axes are where they began."""
        if not self._device.displaced():
            target(now)
            return
        self._target, self._trouble, self._task = target, "", Task(self._device.restore())
        self.stage = Stage.RESTORING

    def _end_from(self, now: float) -> None:
        self._leave(self._end, now)

    def _next(self, now: float) -> None:
        self._index += 1
        if self._index >= len(self._steps):
            self._index = len(self._steps) - 1
            self._finish(now)
            return
        self._prompt(now)

    def _prompt(self, now: float) -> None:
        self._facts, self._trouble, self._then = (), "", self._show
        if unfit := self.step.unfit(self.findings):
            self._not_seen(unfit)
            self._next(now)
        elif self.step.automatic:
            self._begin()
        else:
            self.stage = Stage.PROMPT

    def _begin(self) -> None:
        self._task = Task(self.step.script(self.findings))
        self.stage = Stage.RUNNING

    def _skip(self, now: float) -> None:
        self._not_seen(SKIPPED)
        self._next(now)

    def _not_seen(self, how: str) -> None:
        known = {fact.key for fact in self.findings.facts if fact.found is not None}
        facts = [each.not_seen(how) for each in self.step.subjects if each.key not in known]
        self.findings = self.findings.with_facts(replace(fact, step=self.step.key) for fact in facts)

    def _end(self, now: float) -> None:
        """The operator ends it: to the final steps where something was found, else out."""
        if self._ending or not self._done_any or self._index >= self._first_final:
            self.reason = self.reason or "ended by the operator"
            self._finish(now)
            return
        self._ending = True
        while self._index < self._first_final - 1:
            self._not_seen(SKIPPED)
            self._index += 1
        self._not_seen(SKIPPED)
        self._next(now)

    def _finish(self, _now: float) -> None:
        self.stage = Stage.OVER

    def _lose(self, trouble: str, now: float) -> None:
        """The link is gone, and with it every way to send anything."""
        finishing = self._then == self._finish and self.stage is Stage.RELEASING
        self._end_task(trouble)
        if finishing:
            self._finish(now)
            return
        self._retry = now + RETRY
        self.stage = Stage.LOST

    def _reopen(self, now: float) -> None:
        if now < self._retry:
            return
        self._retry = now + RETRY
        try:
            self._device.reopen()
        except LinkError as error:
            self._trouble = str(error)
            return
        self._end_task(f"the link was lost, and is back ({self._trouble})")

    @property
    def page(self) -> Page:
        """What there is to see now."""
        step, task, question = self.step, self._task, self._question
        return Page(
            key=step.key,
            number=max(0, self._index) + 1,
            total=len(self._steps),
            title=step.title,
            stage=self.stage,
            lines=step.about,
            consent=step.consent,
            question=question.text if question else "",
            typed=task.typed if task and question and question.word else None,
            progress=task.progress if task and not question else "",
            trouble=self._trouble,
            facts=self._facts,
            keys=keys_on(self.stage, question, bool(self._trouble)),
            displaced=self._device.displaced() if self.stage is Stage.SHOWN else "",
        )
