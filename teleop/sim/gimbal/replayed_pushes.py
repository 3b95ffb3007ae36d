"""What a captured gimbal sent unasked, sent again: at the same times from its beginning, once it is started."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.dji.gimbal import messages as gimbal
from teleop.sim.gimbal.captured_gimbal import Sent, period

GRAIN = 1e-6  # s: what is due within that is due now, as a capture has no finer times


class ReplayedPushes:
    """One kind of them. `begin` is the time in the capture (s) that `start` stands for.

    After the last push of parameters the gimbal goes on with it, at the usual rate: it holds what it reported last.
    """

    def __init__(self, begin: float, sent: Sequence[Sent]) -> None:
        self._pushes = [each._replace(time=each.time - begin) for each in sent]
        is_state = bool(sent) and sent[0].frame.data[:2] == gimbal.Push.set_and_id
        self._period = period([each.time for each in sent]) if is_state else None
        self._started: float | None = None
        self._sent = 0

    @property
    def is_empty(self) -> bool:
        return not self._pushes

    def start(self, now: float) -> None:
        """From `now` (s) on; starting it again changes nothing."""
        self._started = now if self._started is None else self._started

    def stop(self) -> None:
        self._started, self._sent = None, 0

    def due(self, now: float) -> list[Sent]:
        """What is sent since the last call and up to `now`, each with its time by the same clock."""
        if self._started is None:
            return []
        due: list[Sent] = []
        while (following := self._following()) and self._started + following.time <= now + GRAIN:
            due.append(following._replace(time=self._started + following.time))
            self._sent += 1
        return due

    def _following(self) -> Sent | None:
        if self._sent < len(self._pushes):
            return self._pushes[self._sent]
        if self._period is None:
            return None
        last = self._pushes[-1]
        return last._replace(time=last.time + (self._sent - len(self._pushes) + 1) * self._period)
