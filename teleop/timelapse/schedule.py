"""When each frame of a timelapse is due: a closed formula of its number, so that nothing is ever added up."""

from __future__ import annotations

from typing import NamedTuple


class Schedule(NamedTuple):
    """`frames` of them, the intervals between going from `first` to `last`, in s, by equal amounts."""

    first: float
    last: float
    frames: int

    @property
    def change(self) -> float:
        """By how much an interval is longer than the one before it, in s."""
        return (self.last - self.first) / (self.frames - 2) if self.frames > 2 else 0.0

    def at(self, frame: float) -> float:
        """Seconds from frame 0 to this one; between two frames, the parabola through their neighbors."""
        return frame * self.first + self.change * frame * (frame - 1) / 2

    def interval(self, frame: int) -> float:
        """Seconds from this frame to the next."""
        return self.first + self.change * min(frame, max(0, self.frames - 2))

    def speed(self, frame: float) -> tuple[float, float]:
        """Frames per second at this frame, and how that changes (1/s2)."""
        slowness = self.first + self.change * (frame - 0.5)
        return 1 / slowness, -self.change / slowness**3

    def scaled(self, factor: float) -> Schedule:
        return Schedule(self.first * factor, self.last * factor, self.frames)
