"""What the devices have answered to commands that came by the door."""

from __future__ import annotations

from typing import TYPE_CHECKING

from teleop.core.events import Action, DeviceCommand

if TYPE_CHECKING:
    from teleop.remote.asked import Asked

DONE = (": done", ": sent; this command has no reply")


class Told:
    """`camera` has what it has done or refused since it was asked last. Everything here is the control thread's."""

    def __init__(self) -> None:
        self.camera: dict[Action, bool] = {}
        self._watched: dict[str, Asked] = {}  # by the words of the command
        self._failed: dict[Asked, str] = {}
        self._confirmed: set[str] = set()

    def watch(self, asked: Asked, command: DeviceCommand) -> None:
        self._watched[str(command)] = asked
        self._confirmed.discard(str(command))

    def line(self, text: str) -> None:
        """A line for the operator: it may be what became of a command."""
        for words, asked in list(self._watched.items()):
            if text.startswith((f"{words}: ", f"{words} refused")) and not text.endswith(DONE):
                del self._watched[words]
                self._failed[asked] = text

    def confirm(self, command: DeviceCommand) -> None:
        self._watched.pop(str(command), None)
        self._confirmed.add(str(command))

    def camera_answered(self, action: Action, done: bool) -> None:
        self.camera[action] = done

    def confirmed(self, command: DeviceCommand) -> bool:
        return str(command) in self._confirmed

    def failure(self, asked: Asked) -> str:
        """Why it will not be done, once; "" for nothing known."""
        return self._failed.pop(asked, "")
