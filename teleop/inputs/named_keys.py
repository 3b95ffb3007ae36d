"""Each key of a terminal by its name: for pages that say themselves what a key does on them."""

from __future__ import annotations

from collections.abc import Iterator

from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command, Press
from teleop.inputs.keymaps import ESCAPE, Act

KEY = "key"  # the device of the command that a press carries
_SPECIAL = {"\n": "enter", "\r": "enter", " ": "space", "\x7f": "backspace", "\b": "backspace"}
_ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
_SEQUENCES = {f"{ESCAPE}{begin}{final}": name for final, name in _ARROWS.items() for begin in "[O"}


class NamedKeys:
    """From what a terminal sends to keys by name: `enter`, `space`, `left`, or the character itself.

    The space bar is a space wherever it comes, in the middle of a sequence too.
    """

    question = ""
    helping = False

    def __init__(self) -> None:
        self._begun = ""

    @property
    def is_waiting(self) -> bool:
        return bool(self._begun)

    def settle(self) -> None:
        self._begun = ""

    def feed(self, text: str) -> Iterator[Act]:
        text, self._begun = self._begun + text, ""
        while text:
            sequence = next((each for each in _SEQUENCES if text.startswith(each)), "")
            if not sequence and any(each.startswith(text) for each in _SEQUENCES):
                self._begun = text
                return
            name = _SEQUENCES.get(sequence) or _SPECIAL.get(text[0]) or (text[0] if text[0].isprintable() else "")
            if name:
                yield Press(Command.TELL, device_command=DeviceCommand(KEY, name))
            text = text[len(sequence) or 1 :]


def names(presses: list[Press] | tuple[Press, ...]) -> list[str]:
    """The names of the keys pressed."""
    commands = [press.device_command for press in presses]
    return [each.name for each in commands if each is not None and each.device == KEY]
