"""From what a link hears to a capture: absolute times that never step, and no serial numbers unless asked."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

from teleop.captures.captured import FROM_DEVICE, Captured
from teleop.captures.serial_numbers import SerialNumbers
from teleop.captures.writer import CaptureWriter
from teleop.core.clock import date
from teleop.links.can import BusFrame

_DOUBT = 1.0  # s that an adapter's time may be from ours: beyond it counts from another start than 1970


class Recording:
    """Gives `writer` what a listener taps. `now` is a clock in s; `date` the wall clock at the start, in s since 1970.

    A wall clock that is set meanwhile does not move the times; a time never goes back.
    """

    def __init__(
        self,
        writer: CaptureWriter,
        numbers: SerialNumbers | None,
        now: Callable[[], float],
        started: float | None = None,
    ) -> None:
        self._writer, self._numbers, self._now = writer, numbers, now
        self._offset = (date() if started is None else started) - now()
        self._last = -math.inf
        self._heard: deque[Captured] = deque()

    def hear(self, heard: BusFrame | bytes) -> None:
        """What has just arrived: a frame of a CAN bus, or bytes from the device on a serial line."""
        if isinstance(heard, bytes):
            self.hear_from(FROM_DEVICE, heard)
        else:
            time = self._time(heard.stamp)
            self._heard.append(Captured(time, heard.id, heard.data, heard.extended, heard.remote, heard.error))

    def hear_from(self, sender: int, data: bytes) -> None:
        """Bytes of a serial line that have just passed, to the device or from it."""
        self._heard.append(Captured(self._time(None), sender, data))

    def look(self) -> None:
        """Write what has arrived; another thread may do so than the one that hears. Raises OutputError."""
        self._take(self._now() + self._offset)
        self._writer.flush()

    def close(self) -> None:
        """Complete the file. Raises OutputError."""
        try:
            self._take(math.inf)
        finally:
            self._writer.close()

    def summary(self) -> str:
        """The file and what is in it, in a line."""
        count = self._writer.count
        text = f"{self._writer.path}: {count} frame{'' if count == 1 else 's'}"
        if self._numbers is None:
            return f"{text}, with serial numbers"
        blanked = self._numbers.blanked
        return f"{text}, {blanked} serial number{'' if blanked == 1 else 's'} blanked (--serial keeps them)"

    def _take(self, now: float) -> None:
        while self._heard:
            frame = self._heard.popleft()
            if self._numbers:
                self._numbers.add(frame)
            else:
                self._writer.add(frame)
        for frame in self._numbers.settled(now) if self._numbers else ():
            self._writer.add(frame)

    def _time(self, stamp: float | None) -> float:
        ours = self._now() + self._offset
        time = stamp if stamp is not None and abs(stamp - ours) < _DOUBT else ours
        self._last = max(self._last, time)
        return self._last
