"""The camera that the gimbal's RSS cable controls.

Recording is said again when no reply comes, because saying it twice does no harm. The shutter is not: a lost reply
does not mean a lost command, and a frame shot twice is a fault nobody sees. A camera that refuses stops the run, since
a move that is not being filmed is not worth finishing.
"""

from __future__ import annotations

from collections.abc import Mapping

from teleop.dji import camera
from teleop.dji.camera import CameraCommand
from teleop.dji.message import Result
from teleop.motion import Action, Tick
from teleop.ports import DeviceError
from teleop.sinks.connection import Answer, Connection

COMMANDS: Mapping[Action, CameraCommand] = {
    Action.RECORD: CameraCommand.RECORD,
    Action.STOP: CameraCommand.STOP,
    Action.SHUTTER: CameraCommand.SHUTTER,
}
TRIES: Mapping[Action, int] = {Action.RECORD: 3, Action.STOP: 3, Action.SHUTTER: 1}


class CameraSink:
    """Performs the camera actions of a tick, and says when the camera would not."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._pending: dict[int, tuple[Action, int]] = {}  # sequence -> what was asked, for the how manieth time
        self._again: list[tuple[Action, int]] = []
        self._fault = ""
        connection.on_answer(camera.Command, self._answered)

    def write(self, tick: Tick) -> None:
        """Raises DeviceError when the camera refused or did not answer an earlier action."""
        again, self._again = self._again, []
        for action, attempt in [*again, *((action, 1) for action in tick.actions if action in COMMANDS)]:
            sequence = self._connection.request(camera.Command(COMMANDS[action]), tick.time)
            self._pending[sequence] = (action, attempt)
        if self._fault:
            fault, self._fault = self._fault, ""
            raise DeviceError(fault)

    def release(self, now: float) -> float | None:  # noqa: ARG002 - nothing was taken over
        return None

    def _answered(self, answer: Answer) -> None:
        asked = self._pending.pop(answer.sequence, None)
        if asked is None:
            return
        action, attempt = asked
        if isinstance(answer.reply, Result) and answer.reply.return_code:
            self._fault = f"the camera refused to {action} (return code {answer.reply.return_code:#04x})"
        elif answer.reply is None and attempt < TRIES[action]:
            self._again.append((action, attempt + 1))
        elif answer.reply is None:
            self._fault = f"the camera did not answer when asked to {action}"
