"""A fader that sends an axis to a position, and takes it over only where the two meet. Pure: times are given."""

from __future__ import annotations

from teleop.core.axes import Limits

LET_GO = 0.5  # s without a message, after which a fader is taken hold of anew
COARSE_STEP, FINE_STEP = 1 / 127, 1 / 16383
NEAR = 1.5  # steps of the coarse kind within which the two have met


class Fader:
    """`low` and `high` are the positions of its ends, in units."""

    def __init__(self, low: float, high: float) -> None:
        self.low, self.high = low, high
        self.share: float | None = None  # of its way, 0..1, where it was last; None before it was heard
        self.moved_at = -1e9
        self.holds = False  # the axis follows it
        self.sent: float | None = None  # the share that its motor was sent to last

    @classmethod
    def of(cls, low: float | None, high: float | None, limits: Limits) -> Fader:
        """With the soft limits for ends that are not given."""
        return cls(limits.minimum if low is None else low, limits.maximum if high is None else high)

    def position(self, share: float) -> float:
        return self.low + share * (self.high - self.low)

    def share_of(self, position: float) -> float:
        return (position - self.low) / (self.high - self.low)

    def moved(self, share: float, position: float, now: float) -> float | None:
        """Where its axis is to go, which is at `position`; None while the fader has not met it."""
        before, self.share = self.share, share
        here = self.share_of(position)
        if now - self.moved_at > LET_GO:
            self.holds = before is not None and abs(before - here) <= NEAR * COARSE_STEP
        self.moved_at = now
        if not self.holds:
            met = abs(share - here) <= NEAR * COARSE_STEP
            self.holds = met or (before is not None and (before - here) * (share - here) < 0)
        return self.position(share) if self.holds else None

    def let_go(self) -> None:
        """The axis does not follow it: another has control, or the rig is stopped."""
        self.holds = False

    def motor_share(self, position: float, now: float, fine: bool) -> float | None:
        """Where its motor is to go; None while a hand moves it, and where it is there already."""
        if now - self.moved_at <= LET_GO:
            self.sent = None
            return None
        share = min(max(self.share_of(position), 0.0), 1.0)
        if self.sent is not None and abs(share - self.sent) < (3 * FINE_STEP if fine else COARSE_STEP / 2):
            return None
        self.sent = self.share = share
        return share
