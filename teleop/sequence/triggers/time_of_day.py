"""A trigger at a time of day: the next one that a clock on the wall shows, whatever is done to that clock meanwhile."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack
from datetime import datetime, time, timedelta

from teleop.core.clock import date
from teleop.core.errors import DeviceError
from teleop.core.timing import PERIOD
from teleop.sequence.triggers.written import WrittenError

_TIME = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)(?::([0-5]\d))?")
SET = 1.0  # s: a clock that runs away from the loop's by more has been set


class ClockTrigger:
    """The next `text` (18:30 or 18:30:00) of this computer's wall clock, which decides.

    Set forward past that time, it starts; set back, it waits for the next one from there. A time that a change to
    summer time leaves out comes an hour later; of one that there is twice in a night the next one counts. `now` is the
    loop's clock, which is never set, to tell a clock that was set from a rig that was late. Raises WrittenError.
    """

    again = False

    def __init__(self, text: str, wall: Callable[[], float] = date, now: Callable[[], float] | None = None) -> None:
        match = _TIME.fullmatch(text)
        if match is None:
            raise WrittenError("must be a time of day, as in time:18:30:00")
        hour, minute, second = (int(part or 0) for part in match.groups())
        self._time = time(hour, minute, second)
        self._wall, self._now = wall, now
        self._seen = wall()
        self._ahead = self._seen - now() if now else None  # of the loop's clock
        self._at = _next(self._time, self._seen)

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None:
        late = self._look() - self._at
        was_set = self._ahead is not None and self._seen - now - self._ahead > max(SET, late)
        if late > PERIOD and not was_set:
            raise DeviceError(f"{self._name} was {late:.1f} s before the rig reached the start")

    def fired(self, now: float) -> bool:  # noqa: ARG002 - the wall clock decides
        return self._look() >= self._at - PERIOD / 2

    def waits_for(self, now: float) -> str:  # noqa: ARG002
        seen = self._look()  # first: it may change what is waited for
        left = max(0, round(self._at - seen))
        parts = ((left // 3600, "h"), (left // 60 % 60, "min"), (left % 60, "s"))
        return f"{self._name}, in {' '.join(f'{count} {unit}' for count, unit in parts if count) or '0 s'}"

    @property
    def _name(self) -> str:
        at, today = datetime.fromtimestamp(self._at), datetime.fromtimestamp(self._seen).date()
        return f"{self._time:%H:%M:%S}{' tomorrow' if at.date() > today else ''}"

    def _look(self) -> float:
        """The wall clock; one that was set back shows the time that is waited for again."""
        before, self._seen = self._seen, self._wall()
        if self._seen < before:
            self._at = _next(self._time, self._seen)
        return self._seen


def _next(of_day: time, wall: float) -> float:
    """When the clock shows a time next, in seconds since 1970."""
    today = datetime.fromtimestamp(wall).date()
    moments = []
    for days in range(3):
        for fold in (0, 1):
            written = datetime.combine(today + timedelta(days=days), of_day.replace(fold=fold))
            moment = written.timestamp()
            shown = datetime.fromtimestamp(moment)
            if fold == 0 or (shown.time() == of_day and shown.fold == 1):
                moments.append(moment)
    return min(moment for moment in moments if moment > wall)
