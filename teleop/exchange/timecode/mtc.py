"""MIDI timecode's quarter frames to readings: eight of them spell a label, which began when the first one came. Pure.

The times of all eight count: each tells when the frame began, so that what is uneven in one matters little.
"""

from __future__ import annotations

from collections.abc import Sequence

from teleop.exchange.timecode.reading import Fault, Reading
from teleop.sequence.triggers.midi_timecode import DROP, PIECES, RATES, WHOLE, spelled

QUARTER = 0xF1
BACKWARDS = 4  # pieces in falling order


class MtcDecoder:
    """`fps` is the profile's, None to take what the code tells."""

    def __init__(self, fps: float | None = None) -> None:
        self._fps = fps
        self._pieces: list[int] = []
        self._times: list[float] = []
        self._last = -1
        self._falling = 0

    def take(self, data: Sequence[int], now: float) -> Reading | Fault | None:
        """A MIDI message that came at `now` (s); None for one that completes nothing."""
        if len(data) != 2 or data[0] != QUARTER or not 0 <= data[1] <= 127:
            return None
        piece, value = data[1] >> 4, data[1] & 15
        self._falling = self._falling + 1 if piece == (self._last - 1) % PIECES else 0
        self._last = piece
        if self._falling >= BACKWARDS:
            self._pieces, self._times = [], []
            return Fault("runs backwards") if self._falling % BACKWARDS == 0 else None
        if piece != len(self._pieces):
            self._pieces, self._times = [], []
            if piece != 0:
                return None
        self._pieces.append(value)
        self._times.append(now)
        return self._spelled() if len(self._pieces) == PIECES else None

    def _spelled(self) -> Reading:
        pieces, times, self._pieces, self._times = self._pieces, self._times, [], []
        rate, label = spelled(pieces)
        quarter = 1 / (4 * (self._fps or RATES[rate]))
        began = sum(time - number * quarter for number, time in enumerate(times)) / PIECES
        return Reading(began, label, rate == DROP, WHOLE[rate])
