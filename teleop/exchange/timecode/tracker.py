"""Where timecode is, from its readings: a line over our clock, once they agree; and why it cannot be followed. Pure.

The line is a fit to the last two seconds, so that readings that come unevenly, and a sender whose clock is a little
fast or slow, make no difference. It is one of medians: a busy computer hears some readings much too late, and a fit of
squares would take that for another speed. What does not go on as expected breaks the lock.
"""

from __future__ import annotations

import math
from collections import deque
from fractions import Fraction
from statistics import median

from teleop.config.frame_rates import drops, shown_rate, whole_rate
from teleop.exchange.timecode.reading import Fault, Label, Reading, exact_fps, frame, is_label, wrapped
from teleop.planner.chasing import Reference

WINDOW = 2.0  # s of readings that count
SLOPE = 1.0  # s of them, from which on the sender's speed is known
LOCK, LEAST = 0.15, 3  # s and readings that must agree
LOST = 0.2  # s without timecode
JUMP = 0.06  # s by which a reading may be off what was expected
SPEED = 0.01  # by which the sender may be faster or slower


class Tracker:
    """`rate` is the profile's, None for what the code tells; `at` is the label where the move begins.

    `why` is what is wrong, "" while nothing is. `locks` counts how often it was locked. `offset` is what our clock is
    ahead of the one that the readings are timed by (s); it may change, as more is learned.
    """

    def __init__(self, rate: float | None, at: Label, latency: float = 0.0) -> None:
        self._rate, self._at, self._latency = rate, at, latency
        self._readings: deque[tuple[float, float]] = deque()  # time, and s of the code since the first one
        self._last: Reading | None = None
        self._heard = -math.inf
        self._began = 0  # the frame of the first one
        self._whole, self._drop, self._fps = 0, False, Fraction(1)
        self.locked = False
        self.locks = 0
        self.offset = 0.0
        self.why = ""

    def hear(self, now: float) -> None:
        """Something of it has come."""
        self._heard = now

    def take(self, found: Reading | Fault, now: float) -> None:
        """A reading that was complete at `now` (s)."""
        self._heard = now
        if isinstance(found, Fault):
            self._break(found.why)
            return
        if why := self._refused(found):
            self._break(why)
            return
        self._add(found)

    def look(self, now: float) -> None:
        """At `now` nothing more has come."""
        if self._last is not None and now - self._heard > LOST:
            self._break("is lost")

    def reference(self, now: float) -> Reference | None:
        """The place in the move, and how fast it goes; None while it is not locked."""
        if not self.locked:
            return None
        slope, middle, place = self._line()
        start = wrapped(self._began - frame(self._at, self._whole, self._drop), self._whole, self._drop) / self._fps
        return Reference(float(start) + place + slope * (now - self.offset - middle + self._latency), now, slope)

    def _refused(self, found: Reading) -> str:
        """Why a reading is none of this profile's timecode."""
        whole = found.whole or whole_rate(self._rate or 0)
        if self._rate is not None and whole != whole_rate(self._rate):
            return f"counts {whole} frames in a second, not {shown_rate(self._rate)}"
        if found.drop and self._rate is not None and not drops(self._rate):
            return f"drops frame numbers, which {shown_rate(self._rate)} does not"
        if not is_label(found.label, whole, found.drop):
            return "has a label that does not exist"
        return ""

    def _add(self, found: Reading) -> None:
        last = self._last
        whole = found.whole or whole_rate(self._rate or 0)
        if last is None or (whole, found.drop) != (self._whole, self._drop):
            if last is not None:
                self._break("changes its rate")
            self._whole, self._drop = whole, found.drop
            self._fps = exact_fps(self._rate, whole, found.drop)
            self._began = frame(found.label, whole, found.drop)
        elif why := self._off(last, found):
            self._break(why)
            self._began = frame(found.label, whole, found.drop)
        self._last = found
        self._readings.append((found.time, self._since(found)))
        while self._readings[-1][0] - self._readings[0][0] > WINDOW:
            self._readings.popleft()
        self._judge()

    def _since(self, found: Reading) -> float:
        """Seconds of the code since the first reading of this lock."""
        frames = wrapped(frame(found.label, self._whole, self._drop) - self._began, self._whole, self._drop)
        return float(Fraction(round(frames)) / self._fps)

    def _off(self, last: Reading, found: Reading) -> str:
        """Why a reading does not go on from the one before it."""
        went, time = self._since(found) - self._since(last), found.time - last.time
        if went == 0:
            return "stands still"
        if went < 0:
            return "runs backwards" if went > -1.0 else "jumps"
        return "jumps" if abs(went - time) > JUMP else ""

    def _judge(self) -> None:
        span = self._readings[-1][0] - self._readings[0][0]
        if span > SLOPE and abs(self._line()[0] - 1) > SPEED:
            fps = float(self._fps) * self._line()[0]
            self._break(f"runs at {fps:.2f} frames per second, not {shown_rate(float(self._fps))}")
        elif not self.locked and span >= LOCK and len(self._readings) >= LEAST:
            self.locked, self.why = True, ""
            self.locks += 1

    def _line(self) -> tuple[float, float, float]:
        """The slope, and a time and the place of the code then."""
        half = len(self._readings) // 2
        middle = median(time for time, _ in self._readings)
        slope = 1.0
        if self._readings[-1][0] - self._readings[0][0] >= SLOPE:
            pairs = zip(self._readings, list(self._readings)[-half:], strict=False)
            slope = median((after[1] - before[1]) / max(after[0] - before[0], 1e-9) for before, after in pairs)
        return slope, middle, median(at - slope * (time - middle) for time, at in self._readings)

    def _break(self, why: str) -> None:
        self._readings.clear()
        self._last = None
        self.locked, self.why = False, why
