"""From what a stick reports to the share of full speed it asks for, in the operator's order.

Center calibration, inversion, dead zone, expo: each keeps 0 at 0 and the ends at the ends, so that what follows need
not know which of them there were. Only `Center` remembers anything: where a stick lay when it was plugged in.
"""

from __future__ import annotations

import math

NEAR = 0.1  # of the way to an end: what rests further out is a throttle, a trigger or a slider, or is held
FINDING = 0.25  # s of rest by which a center is learned
REST_SPREAD = 0.05  # of the way to an end: what wanders further meanwhile is not at rest


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


def deflect(value: float, low: float, center: float, high: float) -> float:
    """-1..1 with 0 at the center; both ends are reached, also when the center is not in the middle."""
    if (value - center) * (high - low) >= 0:
        return share(value, center, high) if high != center else 0.0
    return -share(value, center, low) if low != center else 0.0


class Center:
    """Where a stick rests, learned by watching it for a moment after it was plugged in; until then it has none.

    Only a stick that lies still near the middle teaches its center. Any other has the middle of its range, until it is
    first seen to rest near there. `centered` is whether it was near the middle when first seen: what was not is a
    throttle, a trigger or a slider, or is held. `at_end` is whether it then was at an end, as triggers are.
    `learned` is whether `value` was seen, or `given`, and not assumed.
    """

    def __init__(self, low: float, high: float, given: float | None = None) -> None:
        self.value = given
        self.learned = given is not None
        self.centered, self.at_end = True, False
        self._given = given is not None
        self._middle, self._reach = (low + high) / 2, abs(high - low) / 2
        self._first: float | None = None
        self._since = math.inf  # when it was first seen, and later when it came to rest
        self._least = self._most = self._sum = 0.0
        self._count = 0

    def see(self, value: float, now: float) -> None:
        """The stick's value at `now`, s; once its center is learned nothing changes any more."""
        if self._given:
            return
        if self._first is None:
            self._first, self.centered = value, self._near(value)
            self.at_end = abs(value - self._middle) >= (1 - NEAR) * self._reach
            self._begin(value, now)
        if self.learned or (self.value is not None and self.centered):
            return
        late = self.value is not None
        self._least, self._most = min(self._least, value), max(self._most, value)
        still = self._most - self._least <= REST_SPREAD * self._reach and (not late or self._near(value))
        if late and not still:
            self._begin(value, now)
            return
        self._sum, self._count = self._sum + value, self._count + 1
        if now - self._since < FINDING:
            return
        rest = self._sum / self._count
        self.learned = still and self._near(rest)
        self.value = rest if self.learned else self._middle
        if not late:
            self._begin(value, now)

    def has(self, value: float) -> bool:
        """Whether the stick is where its center is known to be."""
        return self.value is not None and abs(value - self.value) <= REST_SPREAD * self._reach

    def _begin(self, value: float, now: float) -> None:
        self._since, self._least, self._most, self._sum, self._count = now, value, value, 0.0, 0

    def _near(self, value: float) -> bool:
        return abs(value - self._middle) <= NEAR * self._reach
