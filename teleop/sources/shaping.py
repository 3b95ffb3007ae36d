"""From what a stick reports to the share of full speed it asks for: pure functions, in the operator's order."""

from __future__ import annotations

import math


def shape(deflection: float, dead_zone: float, expo: float) -> float:
    """A deflection of -1..1 as a share of -1..1: the dead zone, rescaled so that nothing jumps at its edge, then expo.

    `dead_zone` is the deflection below which there is nothing (0..0.3), `expo` how much of the answer is cubic
    (0..0.75), which makes slow moves finer; 0 and 0 leave the deflection as it is. Source: design page operation.md,
    Live.
    """
    beyond = max(0.0, (min(abs(deflection), 1.0) - dead_zone) / (1 - dead_zone))
    return math.copysign((1 - expo) * beyond + expo * beyond**3, deflection)
