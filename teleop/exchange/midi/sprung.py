"""A wheel with a spring that moves an axis, with a dead man's rule of its own. Pure: times are given.

MIDI says nothing while a wheel is held still. So a deflection counts for as long as messages come: the wheel's own, or
the controller's Active Sensing, which it sends at least every 0.3 s. Otherwise the axis comes to rest, and the wheel
has to be seen in its center.
"""

from __future__ import annotations

CENTER, FURTHEST = 8192, 8191
DEAD = 0.02  # of the deflection, around the center
REPEATS = 0.25  # s that a deflection counts without another message
SENSING = 0.35  # s that it counts after Active Sensing


class Sprung:
    """`late` is whether it was deflected for longer than it was heard."""

    def __init__(self) -> None:
        self.late = False
        self._value = 0.0
        self._moved = self._sensed = -1e9

    def moved(self, value: int, now: float) -> None:
        """A bend of 0..16383."""
        share = max(-1.0, (value - CENTER) / FURTHEST)
        self._value = share if abs(share) > DEAD else 0.0
        self._moved = now
        if not self._value:
            self.late = False

    def sensed(self, now: float) -> None:
        """The controller has said that it is there."""
        self._sensed = now

    def deflection(self, now: float) -> float:
        """-1..1 at `now`."""
        if self._value and now - self._moved > REPEATS and now - self._sensed > SENSING:
            self.late = True
        return 0.0 if self.late else self._value
