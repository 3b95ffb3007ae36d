"""The keys of `teleop live --learn`."""

from __future__ import annotations

from collections.abc import Mapping

from teleop.core.operator_input import Command, Press
from teleop.inputs.keymaps import Act

ACCEPT, BACK, TRY, AGAIN = Command.GO, Command.PREVIOUS, Command.NEXT, Command.RECALL
YES, NO, LEAVE = Command.KEEP, Command.CLEAR, Command.QUIT
"""What the keys ask for here, in the words that there are: Enter is `go`, b the question before, t the next page."""

KEYS: Mapping[str, Act] = {
    **dict.fromkeys(("\n", "\r"), Press(ACCEPT)),
    "b": Press(BACK),
    "t": Press(TRY),
    "r": Press(AGAIN),
    "y": Press(YES),
    "n": Press(NO),
    "q": Press(LEAVE),
}
