"""The shutter of a timelapse: pressed once for each frame, and the camera's answer passed on.

Unlike a film's camera (sinks/camera.py) one that does not shoot ends nothing here: what that means for the shoot is
decided where the frames are counted. The press is never repeated, because a lost reply is no lost command. Letting go
does no harm twice, and a shutter or a focus that stays pressed would block the camera, so both are let go on leaving.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from teleop.core.events import Exposure, ShutterResult, ShutterStep, Tick
from teleop.devices.connection import Answer, Connection
from teleop.dji.gimbal import camera
from teleop.dji.gimbal.camera import CameraCommand
from teleop.dji.message import Result

COMMANDS: Mapping[ShutterStep, CameraCommand] = {
    ShutterStep.FOCUS: CameraCommand.CENTER_FOCUS,
    ShutterStep.PRESS: CameraCommand.SHUTTER,
    ShutterStep.RELEASE: CameraCommand.STOP_SHUTTER,
}
TRIES = 3  # of letting go
LISTEN = 0.02  # s between looks for an answer on leaving


class ShutterSink:
    """Shoots with the camera on a connection; `on_result` is called with the outcome of each press."""

    def __init__(self, connection: Connection, on_result: Callable[[ShutterResult], object]) -> None:
        self._connection, self._on_result = connection, on_result
        self._pending: dict[int, tuple[int, CameraCommand, int]] = {}  # sequence -> frame, command, which try
        self._held: set[CameraCommand] = set()  # what has to be let go
        self._again: list[tuple[int, CameraCommand, int]] = []
        connection.on_answer(camera.Command, self._answered)

    @property
    def holds(self) -> bool:
        """Whether the shutter, or a focus, is pressed."""
        return bool(self._held)

    def write(self, tick: Tick) -> None:
        self._retry(tick.time)
        for act in tick.actions:
            if not isinstance(act, Exposure):
                continue
            if act.step is ShutterStep.RELEASE and CameraCommand.CENTER_FOCUS in self._held:
                self._ask(act.frame, CameraCommand.END_CENTER_FOCUS, tick.time)
            self._ask(act.frame, COMMANDS[act.step], tick.time)

    def release(self, now: float) -> float | None:
        """Let go, and hear what becomes of a press that has not been answered."""
        self._retry(now)
        for pressed, let_go in LET_GO.items():
            if pressed in self._held:
                self._ask(-1, let_go, now)
        self._connection.poll(now)
        return now + LISTEN if self._pending or self._again else None

    def _retry(self, now: float) -> None:
        again, self._again = self._again, []
        for frame, command, attempt in again:
            self._ask(frame, command, now, attempt)

    def _ask(self, frame: int, command: CameraCommand, now: float, attempt: int = 1) -> None:
        if command in LET_GO:
            self._held.add(command)
        self._held -= {pressed for pressed, let_go in LET_GO.items() if let_go is command}
        self._pending[self._connection.request(camera.Command(command), now)] = frame, command, attempt

    def _answered(self, answer: Answer) -> None:
        if answer.sequence not in self._pending:
            return
        frame, command, attempt = self._pending.pop(answer.sequence)
        if command is CameraCommand.SHUTTER:
            code = answer.reply.return_code if isinstance(answer.reply, Result) else None
            self._on_result(ShutterResult(frame, None if answer.reply is None else code or 0))
        elif answer.reply is None and command not in LET_GO and attempt < TRIES:
            self._again.append((frame, command, attempt + 1))


LET_GO: Mapping[CameraCommand, CameraCommand] = {
    CameraCommand.SHUTTER: CameraCommand.STOP_SHUTTER,
    CameraCommand.CENTER_FOCUS: CameraCommand.END_CENTER_FOCUS,
}
