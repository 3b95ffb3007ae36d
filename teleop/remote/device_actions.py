"""What clients have the camera and the gimbal itself do: asked for, and done once the device says so."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from teleop.config.device_commands import rig_command
from teleop.core.events import Action
from teleop.core.operator_input import Command
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.jobs import JobSource
from teleop.remote.told import Told

CAMERA_TIME = 4.0  # s for the camera's answer
ANSWER_TIME = 2.0  # s for the gimbal's


@dataclass
class Due:
    """What is asked of a device or a move, until `done` or `by`; `failed` is why it will not be, "" unless known."""

    asked: Asked
    done: Callable[[float], bool]
    by: float
    missing: str
    failed: Callable[[], str]


class DueList:
    """What clients wait for."""

    def __init__(self) -> None:
        self._due: list[Due] = []

    def add(self, due: Due) -> None:
        self._due.append(due)

    def of(self, session: str) -> bool:
        """Whether that session waits for something."""
        return any(each.asked.command.session == session for each in self._due)

    def look(self, now: float) -> None:
        """Tell those whose wait is over."""
        for due in list(self._due):
            why, done = due.failed(), due.done(now)
            if done or why or now > due.by:
                self._due.remove(due)
                due.asked.end("" if done else why or due.missing)


class DeviceActions:
    """`has_camera` and `has_gimbal` are the rig's. `rests` is whether every axis does."""

    def __init__(self, jobs: JobSource, told: Told, due: DueList, rests: Callable[[], bool], has_gimbal: bool) -> None:
        self._jobs, self._told, self._due, self._rests, self._has_gimbal = jobs, told, due, rests, has_gimbal
        self.has_camera = False
        self.desk: Desk

    def camera(self, asked: Asked, now: float, action: Action) -> None:
        if not self.has_camera:
            raise Refusal("this rig has no camera")
        asked.accept()
        self._jobs.events.append(action)
        self._told.camera.pop(action, None)
        done = lambda _now: self._told.camera.get(action, False)  # noqa: E731
        failed = lambda: "" if self._told.camera.get(action, True) else "the camera has not done it"  # noqa: E731
        self._due.add(Due(asked, done, now + CAMERA_TIME, "no answer of the camera", failed))

    def follow(self, asked: Asked, now: float) -> None:
        self._tell(asked, now, f"gimbal follow {asked['mode']}", {})

    def message(self, asked: Asked, now: float) -> None:
        self._tell(asked, now, asked["name"], asked.get("fields", {}))

    def _tell(self, asked: Asked, now: float, name: str, fields: Mapping[str, Any]) -> None:
        """A command of a device's own: at rest, and none that the stream of the run would take back."""
        from teleop.dji.gimbal.command_table import find, is_taken_back
        from teleop.dji.message import FieldError

        words = [*name.replace(".", " ").split(), *(f"{key}={_written(value)}" for key, value in fields.items())]
        try:
            message = find(words)
            message.check()
        except FieldError as error:
            raise Refusal(f"{name}: {error}") from None
        if is_taken_back(message):
            raise Refusal(f"{name}: would disturb the commands of the run")
        if not self._has_gimbal:
            raise Refusal("this rig has no gimbal")
        if not self._rests():
            raise Refusal("an axis is moving")
        command = rig_command(words)
        asked.accept()
        self._told.watch(asked, command)
        self.desk.press(asked.command.name, Command.TELL, 0, command)
        if not message.has_reply:
            asked.end()
            return
        done = lambda _now: self._told.confirmed(command)  # noqa: E731
        self._due.add(Due(asked, done, now + ANSWER_TIME, "no answer", lambda: self._told.failure(asked)))


def _written(value: object) -> str:
    if isinstance(value, bool):
        return str(int(value))
    return f"{value:g}" if isinstance(value, float) and math.isfinite(value) else str(value)
