"""A right stick or two triggers: on a device that is not described, both have the same names.

What was at an end when first seen is taken for a trigger, and then so is its neighbor, which may be held: it
moves nothing. But a stick may have been held there. It goes back to its center as soon as it is released, with both
of its axes at once, where triggers never rest. A lone axis (the twist of a joystick) has to rest there for longer than
a finger keeps a trigger half way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from teleop.inputs.hid.controls import Stick
from teleop.inputs.stick_shaping import FINDING

PAIRS = (("Rx", "Ry"), ("Z", "Rz"))  # X and Y are a stick on every pad
LONE = 1.0  # s of rest by which a lone axis is known to be a stick


class Pair:
    """The sticks of one of `PAIRS` that a device has."""

    def __init__(self, sticks: Sequence[Stick]) -> None:
        self._sticks = sticks
        self._needed = FINDING if len(sticks) > 1 else LONE
        self._since = math.inf  # when all of them came to rest in the middle
        self._is_stick = False

    def see(self, now: float) -> None:
        """Judge them by what was just read."""
        if self._is_stick or not any(stick.center is not None and stick.center.at_end for stick in self._sticks):
            return
        rest = all(stick.at_center for stick in self._sticks)
        self._since = min(self._since, now) if rest else math.inf
        self._is_stick = now - self._since >= self._needed
        for stick in self._sticks:
            stick.is_trigger = stick.uncentered and not self._is_stick
