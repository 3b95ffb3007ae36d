"""What the camera answers to an operator who has it record or shoot, in a line: it is not seen to do so otherwise.

A run by hand goes on when the camera refuses or is absent: the operator reads it and drives on. A move that plays by
itself ends instead, because a move that is not filmed is not worth finishing.
"""

from __future__ import annotations

from collections.abc import Callable

from teleop.core.events import Action, Tick
from teleop.devices.camera import CameraSink

DONE = {Action.RECORD: "camera: recording", Action.STOP: "camera: stopped", Action.SHUTTER: "camera: shutter released"}
ABSENT = {Action.RECORD: "record", Action.STOP: "stop", Action.SHUTTER: "shutter"}


class CameraAnswers:
    """An observer; `camera` is the rig's, None where it has none.

    `notify` gets a line for each answer, and `answered` the action with whether the camera has done it. With `lenient`
    a refusal, or no answer, does not end the run.
    """

    def __init__(
        self,
        camera: CameraSink | None,
        notify: Callable[[str], object],
        answered: Callable[[Action, bool], object] = lambda _action, _done: None,
        lenient: bool = False,
    ) -> None:
        self._camera, self._notify, self._answered = camera, notify, answered
        if camera is not None:
            camera.on_done = self._done
            if lenient:
                camera.on_failed = self._failed

    def observe(self, tick: Tick) -> None:
        if self._camera is not None:
            self._camera.poll(tick.time)
            return
        for act in tick.actions:
            if isinstance(act, Action) and act in ABSENT:
                self._notify(f"{ABSENT[act]}: this rig has no camera")
                self._answered(act, False)

    def _done(self, action: Action) -> None:
        self._notify(DONE.get(action, "camera: done"))
        self._answered(action, True)

    def _failed(self, action: Action, reason: str) -> None:
        self._notify(reason)
        self._answered(action, False)
