"""From what a stick reports to the share of full speed it asks for, in the operator's order.

Centre calibration, inversion, dead zone, expo: each keeps 0 at 0 and the ends at the ends, so that what follows need
not know which of them there were. Only `Centre` remembers anything: where a stick lay when it was plugged in.
"""

from __future__ import annotations

import math

MIDDLE = 0.25  # of the way to an end: what rests further out is a throttle, a trigger or a slider
FINDING = 0.25  # s of rest by which a centre is found
STILL = 0.05  # of the way to an end: what wanders further meanwhile is in a hand


def shape(deflection: float, dead_zone: float, expo: float) -> float:
    """A deflection of -1..1 as a share of -1..1: the dead zone, rescaled so that nothing jumps at its edge, then expo.

    `dead_zone` is the deflection below which there is nothing (0..0.3), `expo` how much of the answer is cubic
    (0..0.75), which makes slow moves finer; 0 and 0 leave the deflection as it is. It is the expo of RC transmitters.
    """
    beyond = max(0.0, (min(abs(deflection), 1.0) - dead_zone) / (1 - dead_zone))
    return math.copysign((1 - expo) * beyond + expo * beyond**3, deflection)


def share(value: float, low: float, high: float) -> float:
    """Where `value` lies between the ends, 0..1; beyond an end it is at the end. `low` may be the greater number."""
    return min(max((value - low) / (high - low), 0.0), 1.0)


def deflect(value: float, low: float, centre: float, high: float) -> float:
    """-1..1 with 0 at the centre; both ends are reached, also when the centre is not in the middle."""
    if (value - centre) * (high - low) >= 0:
        return share(value, centre, high) if high != centre else 0.0
    return -share(value, centre, low) if low != centre else 0.0


class Centre:
    """Where a stick rests, found by watching it for a moment after it was plugged in; until then it has none.

    A stick that lies still near the middle has its centre there, any other the middle of its range. `centred` is
    whether it was near the middle when first seen: what was not is a throttle, a trigger or a slider, or is held.
    """

    def __init__(self, low: float, high: float, given: float | None = None) -> None:
        self.value = given
        self.centred = True
        self._middle, self._reach = (low + high) / 2, abs(high - low) / 2
        self._since = math.inf
        self._seen: list[float] = []

    def see(self, value: float, now: float) -> None:
        """The stick's value at `now`, s; once its centre is found nothing changes any more."""
        if self.value is not None:
            return
        if not self._seen:
            self._since, self.centred = now, self._near(value)
        self._seen.append(value)
        if now - self._since < FINDING:
            return
        rest = sum(self._seen) / len(self._seen)
        still = max(self._seen) - min(self._seen) <= STILL * self._reach
        self.value = rest if still and self._near(rest) else self._middle

    def _near(self, value: float) -> bool:
        return abs(value - self._middle) <= MIDDLE * self._reach
