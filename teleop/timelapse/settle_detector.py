"""Whether the axes are measured to be still: what a gimbal says of itself, which is a tenth of a degree."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

from teleop.core.axes import Axis, Reading

WINDOW = 0.2  # s over which a rate is taken: five readings at 25 Hz
ENOUGH = 0.15  # s that they have to span


class SettleDetector:
    """Still is an axis whose readings change by less than `below` unit/s; None: it is not looked at."""

    def __init__(self, below: float | None) -> None:
        self._below = below
        self._readings: dict[Axis, deque[Reading]] = {}

    def reset(self) -> None:
        """Forget all readings: the axes have just moved."""
        self._readings.clear()

    def update(self, reported: Mapping[Axis, Reading]) -> None:
        for axis, reading in reported.items():
            seen = self._readings.setdefault(axis, deque())
            if not seen or reading.time > seen[-1].time:
                seen.append(reading)
            while seen[-1].time - seen[0].time > WINDOW:
                seen.popleft()

    @property
    def reached(self) -> bool:
        return self._below is not None and bool(self._readings) and all(map(self._is_still, self._readings.values()))

    def _is_still(self, seen: deque[Reading]) -> bool:
        first, last = seen[0], seen[-1]
        span = last.time - first.time
        lowest, highest = min(each.position for each in seen), max(each.position for each in seen)
        return span >= ENOUGH and highest - lowest < (self._below or 0.0) * span
