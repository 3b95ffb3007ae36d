"""What the camera answers to an operator who has it record or shoot, in a line: it is not seen to do so otherwise.

A refusal, and no answer, end the run, and the camera's own sink says why; here only what was done is said.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from teleop.core.events import Action, Tick
from teleop.devices.connection import Answer, Connection
from teleop.dji.gimbal import camera
from teleop.dji.message import Result

DONE = {Action.RECORD: "camera: recording", Action.STOP: "camera: stopped", Action.SHUTTER: "camera: shutter released"}
ABSENT = {Action.RECORD: "record", Action.STOP: "stop", Action.SHUTTER: "shutter"}


class CameraAnswers:
    """A watcher; `connection` is the camera's, None where the rig has no camera."""

    def __init__(self, connection: Connection | None, say: Callable[[str], object]) -> None:
        self._connection, self._say = connection, say
        self._asked: deque[Action] = deque()
        if connection is not None:
            connection.on_answer(camera.Command, self._answered)

    def write(self, tick: Tick) -> None:
        for act in tick.actions:
            if isinstance(act, Action) and self._connection is None and act in ABSENT:
                self._say(f"{ABSENT[act]}: this rig has no camera")
            elif isinstance(act, Action):
                self._asked.append(act)
        if self._asked and self._connection is not None:
            self._connection.poll(tick.time)  # where no axis of the run is on this link, nobody else does

    def release(self, now: float) -> float | None:  # noqa: ARG002 - nothing was taken over
        return None

    def _answered(self, answer: Answer) -> None:
        if not self._asked or not isinstance(answer.reply, Result) or answer.reply.return_code:
            return
        self._say(DONE.get(self._asked.popleft(), "camera: done"))
