"""Which key asks what of a sequence that plays, and how the bytes of a terminal become keys.

The space bar is STOP, as everywhere; `p` pauses, which keeps the move on its path. Where a sequence may be trimmed, the
keys that move an axis on are those of `teleop live`, and only `<` and `>` go from key to key.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from teleop.core.axes import Axis
from teleop.core.operator_input import Command, Press
from teleop.inputs.keymaps import ARROWS, INVITE, MODIFIED, STOP, Act, JogStep
from teleop.inputs.keymaps import KEYS as LIVE_KEYS

RIGHT, LEFT = ("\x1b[C", "\x1bOC"), ("\x1b[D", "\x1bOD")
KEYS: Mapping[str, Act] = {
    STOP: Press(Command.STOP),
    "c": Press(Command.CLEAR),
    "p": Press(Command.PAUSE),
    "-": Press(Command.SLOWER),
    "+": Press(Command.FASTER),
    "=": Press(Command.FASTER),
    **dict.fromkeys((">", *RIGHT), Press(Command.NEXT)),
    **dict.fromkeys(("<", *LEFT), Press(Command.PREVIOUS)),
    **dict.fromkeys(("\n", "\r", "g"), Press(Command.GO)),
    "q": Press(Command.QUIT),
}
TRIM_KEYS: Mapping[str, Act] = {
    **{key: act for key, act in KEYS.items() if key not in (*RIGHT, *LEFT)},
    **{key: act for key, act in LIVE_KEYS.items() if isinstance(act, JogStep) and key not in ("<", ">")},
    **{f"\x1b{begin}{final}": JogStep(axis, sign) for final, (axis, sign) in ARROWS.items() for begin in "[O"},
    **{
        f"\x1b[1;{modifier}{final}": JogStep(axis, sign * units)
        for final, (axis, sign) in ARROWS.items()
        for modifier, units in MODIFIED.items()
    },
    "(": JogStep(Axis.ROLL, -1.0),
    ")": JogStep(Axis.ROLL, 1.0),
    "v": Press(Command.RANGE),
    "z": Press(Command.RECENTER),
    "w": Press(Command.KEEP),
}
_RUN = (Command.STOP, Command.CLEAR, Command.PAUSE, Command.GO, Command.QUIT)
RUN_KEYS = {key: act for key, act in KEYS.items() if isinstance(act, Press) and act.command in _RUN}
FLOWN_KEYS = {key: act for key, act in KEYS.items() if key in (STOP, "p", "q")}  # a drone's move has one speed

BY_HAND_KEYS: Mapping[str, Act] = {
    **RUN_KEYS,
    **dict.fromkeys((".", *RIGHT), Press(Command.NEXT)),
    **dict.fromkeys((",", *LEFT), Press(Command.PREVIOUS)),
}


class PlayKeys:
    """From what a terminal sends to what is asked of a sequence; the shape that `Keyboard` wants of its reader."""

    question = ""
    helping = inviting = False

    def __init__(self, keys: Mapping[str, Act] = KEYS) -> None:
        self._keys = keys
        self._begun = ""

    @property
    def is_waiting(self) -> bool:
        return bool(self._begun)

    def settle(self) -> None:
        self._begun = ""
        self.inviting = False

    def feed(self, text: str) -> Iterator[Act]:
        text = self._begun + text
        self._begun = ""
        while text:
            key = next((key for key in self._keys if text.startswith(key)), "")
            if not key and any(known.startswith(text) for known in self._keys):
                self._begun = text
                return
            act = self._keys[key] if key else self._other(text[0])
            if act is not None:
                yield act
            text = text[len(key) or 1 :]

    def _other(self, character: str) -> Act | None:
        """What is in no table."""
        if character == INVITE:
            self.inviting = not self.inviting
        return None
