"""A move that is planned and kept until a moment is named for it: several rigs begin theirs together so.

Nothing moves before that. Then the axes go to its start, and the move begins at the moment itself.
"""

from __future__ import annotations

from teleop.core.axes import Motion
from teleop.remote.asked import Asked, Refusal
from teleop.remote.play_job import PlayJob
from teleop.sequence.common_start import CommonStart

SPARE = 0.1  # s that the axes rest at the start, at least
FARTHEST = 3600.0  # s from now that a start may be


class HeldMove:
    """At most one; its `owner` is the session that has sent it."""

    def __init__(self) -> None:
        self._held: PlayJob | None = None

    def hold(self, asked: Asked, job: PlayJob, motion: Motion) -> None:
        """Keep it instead of the one before, and answer how long it takes, and how long to its start."""
        self.drop("replaced by another move")
        self._held = job
        asked.accept(duration=round(job.source.duration, 3), ease=round(job.source.ease_time(motion), 3))

    @property
    def owner(self) -> str:
        """ "" while there is none."""
        return "" if self._held is None else self._held.owner

    def drop(self, why: str) -> None:
        job, self._held = self._held, None
        if job is not None:
            job.ended(why)

    def start(self, session: str, at: float, now: float, motion: Motion) -> PlayJob:
        """The move, which will begin at `at` by the loop's clock. Raises Refusal where it cannot."""
        job = self._held
        if job is None or job.owner != session:
            raise Refusal("there is no move that waits for its start: send it first")
        trigger = job.source.cycle.trigger
        assert isinstance(trigger, CommonStart)
        begin = at - job.source.lead
        left, ease = begin - now, job.source.ease_time(motion)
        if left > FARTHEST:
            raise Refusal(f"the start is {left:.0f} s away, and may be {FARTHEST:.0f} s away")
        if left < ease + SPARE:
            raise Refusal(f"{job.title} needs {ease + SPARE:.1f} s to its start, and {max(left, 0.0):.1f} s are left")
        trigger.at, self._held = begin, None
        return job
