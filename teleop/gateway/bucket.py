"""How often something may be asked: a bucket that fills with time."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Bucket:
    """May be taken from `burst` times at once, and `rate` times a second in the long run."""

    rate: float
    burst: float
    level: float
    at: float

    def take(self, now: float) -> bool:
        """Whether there was something left at `now` (s)."""
        self.level = min(self.burst, self.level + (now - self.at) * self.rate)
        self.at = now
        if self.level < 1:
            return False
        self.level -= 1
        return True
