"""How an axis of a gimbal answers its commands in one mode: a dead time, a first-order lag, a gain and a drift.

Measured angle = the commanded one, `dead_time` later, through a first-order lag, its speed times `gain`, plus `drift`.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class Response(NamedTuple):
    """`dead_time` and `lag` in s, `gain` as a share, `drift` in units/s; each doubt is a standard error.

    A doubt of inf says that nothing is known of the value.
    """

    dead_time: float
    lag: float
    gain: float = 1.0
    drift: float = 0.0
    delay_doubt: float = math.inf
    gain_doubt: float = math.inf
    drift_doubt: float = math.inf

    @property
    def delay(self) -> float:
        """How much later than commanded a steady motion is, in s."""
        return self.dead_time + self.lag
