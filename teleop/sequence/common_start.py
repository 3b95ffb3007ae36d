"""The start of a move that several rigs have in common: one moment, by the clock of this rig's loop.

The ticks of two rigs do not coincide. So the pass begins at the moment itself, between two ticks, and each tick asks
for the place in the move that belongs to its own time: at one instant all rigs are at the same time of their moves.
"""

from __future__ import annotations

import math
from contextlib import ExitStack

LATEST = 0.1  # s after the moment: a start that comes later is no common one


class CommonStart:
    """A trigger that fires at `at`, inf until that is known. What has missed it waits for the operator's go."""

    again = False

    def __init__(self) -> None:
        self.at = math.inf

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None: ...

    def fired(self, now: float) -> bool:
        return self.at <= now < self.at + LATEST

    def call_off(self) -> None:
        """After a halt there is no common start any more."""
        self.at = math.inf

    def waits_for(self, now: float) -> str:
        left = self.at - now
        if math.isinf(left):
            return "its start to be named"
        return f"the common start in {left:.0f} s" if left > 0 else "enter: the common start was missed"
