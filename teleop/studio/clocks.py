"""How far apart two machines' clocks are: by round trips, and by NTP or PTP where both machines are kept by it.

A round trip of length `r` tells the other clock to within half of it, whatever the two ways took: that is the doubt.
The shortest one counts. Clocks drift, so an old one is worth less.
"""

from __future__ import annotations

import ctypes
import sys
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

MOST_DOUBT = 0.005  # s, above which nothing is started together
DRIFT = 1e-4  # s of doubt that each s adds: twice what two cheap quartzes drift apart
_FAILED, _ERROR = -1, 5  # what adjtimex(2) answers for no clock, and for one that is set by no other: TIME_ERROR


class Offset(NamedTuple):
    """What to add to this machine's clocks for the other's, and the doubt, all in s.

    `loop` is of the monotonic clock, by which the other's control loop runs, `date` of the wall clock. `at` is when
    that was measured, on the own monotonic clock.
    """

    loop: float
    date: float
    doubt: float
    at: float

    def doubt_at(self, now: float) -> float:
        """The doubt by now."""
        return self.doubt + DRIFT * max(0.0, now - self.at)


def measured(answer: Mapping[str, Any], sent: float, arrived: float) -> Offset:
    """The offset that one round trip tells. Raises ValueError for an answer without the times."""
    loop, date, error = answer.get("time"), answer.get("clock"), answer.get("clock_error")
    if not isinstance(loop, int | float) or not isinstance(date, int | float):
        raise ValueError("has no time")
    middle, doubt = (sent + arrived) / 2, (arrived - sent) / 2
    here = time.time() - (time.monotonic() - middle)  # the wall clock then
    offset = Offset(loop - middle, date - here, doubt, arrived)
    own = clock_error()
    if own is None or not isinstance(error, int | float) or own + error >= doubt:
        return offset
    # Both wall clocks are right to within their errors: so they are equal to within the sum.
    return Offset(offset.loop - offset.date, 0.0, own + error, arrived)


def better(before: Offset | None, new: Offset) -> Offset:
    """Which of the two tells more by now."""
    return new if before is None or new.doubt <= before.doubt_at(new.at) else before


class _Timex(ctypes.Structure):
    """The first fields of `struct timex`, and room for the rest."""

    _fields_ = (
        ("modes", ctypes.c_uint),
        ("offset", ctypes.c_long),
        ("freq", ctypes.c_long),
        ("maxerror", ctypes.c_long),
        ("esterror", ctypes.c_long),
        ("rest", ctypes.c_byte * 256),
    )


def clock_error() -> float | None:
    """How wrong this machine's wall clock can be by what NTP or PTP tells the kernel, in s; None where neither does."""
    if sys.platform != "linux":
        return None
    try:
        found = _Timex()
        state = ctypes.CDLL(None).adjtimex(ctypes.byref(found))
    except (OSError, AttributeError):
        return None
    return None if state in (_FAILED, _ERROR) else found.maxerror / 1e6
