"""Each key of a terminal by its name: for pages that say themselves what a key does on them."""

from __future__ import annotations

from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command, Press
from teleop.inputs.keymaps import ESCAPE, Act
from teleop.inputs.playback_keymap import PlayKeys

KEY = "key"  # the device of the command that a press carries
_SPECIAL = {"\n": "enter", "\r": "enter", " ": "space", "\x7f": "backspace", "\b": "backspace"}
_ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
_SEQUENCES = {f"{ESCAPE}{begin}{final}": name for final, name in _ARROWS.items() for begin in "[O"}


class NamedKeys(PlayKeys):
    """From what a terminal sends to keys by name: `enter`, `space`, `left`, or the character itself.

    The space bar is a space wherever it comes, in the middle of a sequence too.
    """

    def __init__(self) -> None:
        super().__init__({key: _named(name) for key, name in (_SPECIAL | _SEQUENCES).items()})

    def _other(self, character: str) -> Act | None:
        return _named(character) if character.isprintable() else None


def _named(name: str) -> Press:
    return Press(Command.TELL, device_command=DeviceCommand(KEY, name))


def names(presses: list[Press] | tuple[Press, ...]) -> list[str]:
    """The names of the keys pressed."""
    commands = [press.device_command for press in presses]
    return [each.name for each in commands if each is not None and each.device == KEY]
