"""The camera that the gimbal's RSS cable controls.

Recording is sent again when no reply comes, because sending it twice does no harm. The shutter is not: a lost reply
does not mean a lost command, and a frame shot twice stays unnoticed. A camera that refuses stops the run, since
a move that is not being filmed is not worth finishing. What this program has set recording it stops on leaving, however
it leaves: otherwise the card fills unnoticed. So it is with a focus that it holds.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from teleop.core.errors import DeviceError
from teleop.core.events import Action, Tick
from teleop.devices.connection import Answer, Connection
from teleop.dji.gimbal import camera
from teleop.dji.gimbal.camera import CameraCommand
from teleop.dji.message import Result

COMMANDS: Mapping[Action, CameraCommand] = {
    Action.RECORD: CameraCommand.RECORD,
    Action.STOP: CameraCommand.STOP,
    Action.SHUTTER: CameraCommand.SHUTTER,
    Action.FOCUS: CameraCommand.CENTER_FOCUS,
    Action.END_FOCUS: CameraCommand.END_CENTER_FOCUS,
}
ENDS: Mapping[Action, Action] = {Action.RECORD: Action.STOP, Action.FOCUS: Action.END_FOCUS}
"""The actions that last until another one, and that other one."""

LISTEN = 0.02  # s between looks for the answer on leaving
TRIES = 3  # how often it is sent without a reply; the shutter once


class CameraSink:
    """Performs the camera actions of a tick.

    `on_done` is called with each action that the camera has confirmed. An action that the camera refuses, or does not
    answer, ends the run; where `on_failed` is set it is called with the action and the reason instead. On leaving, a
    camera that may still be recording is a fault in any case.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._pending: dict[int, tuple[Action, int]] = {}  # sequence -> what was asked, for the how manieth time
        self._again: list[tuple[Action, int]] = []
        self._fault: tuple[Action, str] | None = None
        self._lasting: set[Action] = set()
        self.on_done: Callable[[Action], object] = lambda _action: None
        self.on_failed: Callable[[Action, str], object] | None = None
        connection.on_answer(camera.Command, self._answered)

    @property
    def waiting(self) -> bool:
        """Whether an answer of the camera is still due."""
        return bool(self._pending or self._again)

    def write(self, tick: Tick) -> None:
        """Raises DeviceError when the camera refused or did not answer an earlier action."""
        again, self._again = self._again, []
        for action, attempt in [*again, *((action, 1) for action in tick.actions if isinstance(action, Action))]:
            self._ask(action, attempt, tick.time)
        self._report_fault(self.on_failed)

    def poll(self, now: float) -> None:
        """Read the link while an answer is due: where no axis of the run is on it, nothing else does."""
        if self.waiting:
            self._connection.poll(now)

    def release(self, now: float) -> float | None:
        """Stop what still records, and wait for the camera's word; raises as `write` does."""
        again, self._again = self._again, []
        asked = [(action, attempt) for action, attempt in again if action in ENDS.values()]
        asked += [(ENDS[action], 1) for action in ENDS if action in self._lasting]
        for action, attempt in asked:
            self._ask(action, attempt, now)
        self._connection.poll(now)
        self._report_fault(None)
        waits = self._again or any(action in ENDS.values() for action, _ in self._pending.values())
        return now + LISTEN if waits else None

    def _ask(self, action: Action, attempt: int, now: float) -> None:
        if action in ENDS:
            self._lasting.add(action)
        self._lasting -= {lasting for lasting, end in ENDS.items() if end is action}
        sequence = self._connection.request(camera.Command(COMMANDS[action]), now)
        self._pending[sequence] = (action, attempt)

    def _report_fault(self, report: Callable[[Action, str], object] | None) -> None:
        if self._fault is None:
            return
        (action, reason), self._fault = self._fault, None
        if report is None:
            raise DeviceError(reason)
        self._lasting |= {lasting for lasting, end in ENDS.items() if end is action}  # to be ended on leaving
        report(action, reason)

    def _answered(self, answer: Answer) -> None:
        asked = self._pending.pop(answer.sequence, None)
        if asked is None:
            return
        action, attempt = asked
        if isinstance(answer.reply, Result) and answer.reply.return_code:
            self._lasting.discard(action)
            code = f"return code {answer.reply.return_code:#04x}"
            self._fault = action, f"the camera refused to {_said(action)} ({code})"
        elif isinstance(answer.reply, Result):
            self.on_done(action)
        elif answer.reply is None and action is not Action.SHUTTER and attempt < TRIES:
            self._again.append((action, attempt + 1))
        elif answer.reply is None:
            self._fault = action, f"the camera did not answer when asked to {_said(action)}"


def _said(action: Action) -> str:
    return action.replace("_", " ")
