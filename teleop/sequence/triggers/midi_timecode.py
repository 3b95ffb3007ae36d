"""MIDI timecode: quarter frames and full frames to where the sender's clock is, and whether it runs.

Eight quarter frames spell one timecode, over two frames, so that it is known when the eighth has come: by then it is
seven quarters old. A piece out of turn (lost, or a tape that runs backwards) spoils the eight it belongs to; nothing is
guessed from the rest. MIDI 1.0, "MIDI Time Code": the pieces, the rates and the sysex of a full frame.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from teleop.config.frame_rates import DROPPED, frame_of

RATES = (24.0, 25.0, 30000 / 1001, 30.0)  # frames per s, by the two bits of the code; the third drops frame numbers
WHOLE = (24, 25, 30, 30)  # numbers in a second
DROP = 2  # of RATES
STOPPED = 0.2  # s without a quarter frame, of which there are at least 96 in a second
JUMP = 0.1  # s by which a timecode may be off what was expected before it counts as another
PIECES = 8
FULL_FRAME = (0x7F, None, 0x01, 0x01)  # the head of its sysex; the second byte is a device


class Label(NamedTuple):
    """Timecode as it is written."""

    hours: int
    minutes: int
    seconds: int
    frames: int

    def __str__(self) -> str:
        return ":".join(f"{part:02}" for part in self)

    def time(self, rate: int) -> float:
        """Seconds since 00:00:00:00 at the rate of that code (0..3)."""
        whole = WHOLE[rate]
        if rate != DROP:
            return float(Fraction(frame_of(self, whole), whole))
        return float(Fraction(frame_of(self, whole, DROPPED[whole]) * 1001, whole * 1000))


def spelled(pieces: Sequence[int]) -> tuple[int, Label]:
    """The code of the rate (0..3) and the timecode of eight quarter frames' four bits."""
    frames, seconds, minutes, hours = (pieces[i] | pieces[i + 1] << 4 for i in range(0, PIECES, 2))
    return hours >> 5 & 3, Label(hours & 31, minutes & 63, seconds & 63, frames & 31)


class MidiTimecode:
    """Where the sender's timecode is.

    `starts` counts how often it has begun to run, `jumps` that and how often it has jumped since, and `began` is where
    it did so last (s). `quarters` counts the quarter frames; `run_from` is the number of the first one of this run, and
    `jumped_from` that of the first one that spelled where it began.
    """

    def __init__(self) -> None:
        self.rate = 0  # the code
        self.starts = self.jumps = 0
        self.began = math.nan
        self.quarters = self.run_from = self.jumped_from = 0
        self._pieces: list[int] = []
        self._at = math.nan  # the timecode in s, at `_known`
        self._known = self._heard = -math.inf
        self._ran = False

    def quarter(self, piece: int, value: int, now: float) -> None:
        """A quarter frame: which of the eight, and its four bits."""
        if now - self._heard > STOPPED:
            self._ran, self._pieces = False, []
            self.run_from = self.quarters
        self._heard = now
        self.quarters += 1
        self._pieces = [*self._pieces, value] if piece == len(self._pieces) else [value] if piece == 0 else []
        if len(self._pieces) == PIECES:
            self.rate, label = spelled(self._pieces)
            self._pieces = []
            self._runs(label.time(self.rate), now)

    def full(self, data: tuple[int, ...], now: float) -> None:
        """A full frame, as the bytes of its sysex: where a sender stands that does not run. Others are ignored."""
        head = data[: len(FULL_FRAME)]
        if len(data) != 8 or any(want not in (None, got) for want, got in zip(FULL_FRAME, head, strict=True)):
            return
        hours, minutes, seconds, frames = data[4:]
        self.rate = hours >> 5 & 3
        self._at, self._known = Label(hours & 31, minutes, seconds, frames).time(self.rate), now
        self._ran, self._pieces = False, []
        self._heard = -math.inf

    def runs(self, now: float) -> bool:
        return self._ran and now - self._heard <= STOPPED

    def position(self, now: float) -> float:
        """The timecode at `now` in s, NaN while none is known."""
        return self._at + (now - self._known if self.runs(now) else 0.0)

    def _runs(self, spelled: float, now: float) -> None:
        at = spelled + (PIECES - 1) / 4 / RATES[self.rate]
        self.starts += not self._ran
        if not self._ran or abs(at - self.position(now)) > JUMP:
            self.jumps += 1
            self.began = spelled
            self.jumped_from = self.quarters - PIECES
        self._at, self._known, self._ran = at, now, True
