"""How long an axis takes to get up to speed, and to come to rest: the operator's ease, whichever way it was given.

Seconds, a share of the way between two rests, or a name for such a share all become one value here, and
seconds as soon as that way is known.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from teleop.core.axes import Limits


class Ramp(NamedTuple):
    """So many seconds, and a share (0..0.5) of the time from rest to rest; one of the two is 0."""

    seconds: float = 0.0
    share: float = 0.0

    def over(self, duration: float) -> float:
        """In seconds, of a segment that lasts `duration` seconds."""
        return self.seconds + self.share * duration

    def longer(self, factor: float) -> Ramp:
        """Of a move whose times are all multiplied."""
        return Ramp(self.seconds * factor, self.share)


def together(leave: Ramp, arrive: Ramp) -> float | None:
    """The least seconds of a way that has both ramps, None where it has no room for them however long it is."""
    seconds, share = leave.seconds + arrive.seconds, leave.share + arrive.share
    if seconds == 0:
        return 0.0
    return seconds / (1 - share) if share < 1 else None


def quickest(change: float, limits: Limits) -> float:
    """The seconds that a smooth change of velocity (unit/s, >= 0) takes at least."""
    acceleration, jerk = limits.acceleration, limits.jerk
    if change * jerk < acceleration * acceleration:
        return SMOOTHLY * 2 * math.sqrt(change / jerk)
    return SMOOTHLY * (change / acceleration + acceleration / jerk)


SMOOTHLY = 1.3  # times the time at full jerk, which has no headroom and is no quintic
LONGEST_SHARE = 0.5  # of a segment, at each of its ends
NAMES = {"sharp": Ramp(share=0.1), "medium": Ramp(share=0.25), "soft": Ramp(share=0.4)}
SMOOTH = "smooth"  # the name for no ramp: all of the way is used to be as smooth as can be
