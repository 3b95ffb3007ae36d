"""Frame rates as they are meant: 29.97 is 30000/1001, and so are its relatives; and timecode, which counts frames.

A day of 29.97 taken for 29.97 is 86 ms off, two and a half frames. All is counted in whole frames and fractions, so
that frames and timecode agree for as long as anybody counts. SMPTE ST 12-1 drops the first numbers of each minute but
each tenth, never a frame. Own code, because the library for it (`timecode`) takes a dropped number for another frame
and knows no places in a file; a test has it as the judge of every frame of a day.
"""

from __future__ import annotations

from fractions import Fraction

NTSC = (24, 30, 48, 60, 120)  # whole rates that are also run at 1000/1001 of themselves
NEAR = 0.005  # fps by which a rate may be rounded when it is written: 23.976 and 23.98, 29.97, 59.94
DROPPED = {30: 2, 60: 4, 120: 8}  # numbers that drop-frame timecode leaves out in a minute, by the whole rate


def exact(fps: float) -> Fraction:
    """The rate that is meant by a written one (frames per s): 29.97 is 30000/1001, 23.976 is 24000/1001."""
    for whole in NTSC:
        rate = Fraction(whole * 1000, 1001)
        if abs(fps - rate) < NEAR:
            return rate
    return Fraction(fps)


def exact_rate(fps: float) -> float:
    """As `exact`, as near as a float is; of one that is exact already, the same."""
    return float(exact(fps))


def shown_rate(fps: float) -> str:
    """A rate as people write it: 29.97, 23.976, 25."""
    return f"{round(fps, 3):g}"


def whole_rate(fps: float) -> int:
    """How many numbers timecode counts in a second: 30 at 29.97."""
    rate = exact(fps)
    return -(-rate.numerator // rate.denominator)


def drops(fps: float) -> int:
    """How many numbers drop-frame timecode leaves out in a minute at this rate; 0 where there is none."""
    whole = whole_rate(fps)
    return DROPPED.get(whole, 0) if exact(fps) == Fraction(whole * 1000, 1001) else 0


def is_dropped(minutes: int, seconds: int, frames: int, dropped: int) -> bool:
    """Whether this is a number that `dropped` numbers a minute leave out."""
    return minutes % 10 != 0 and seconds == 0 and frames < dropped


def frame_of(label: tuple[int, int, int, int], whole: int, dropped: int = 0) -> int:
    """The frame, from 0, of a timecode (hours, minutes, seconds, frames)."""
    hours, minutes, seconds, frames = label
    minutes += hours * 60
    return (minutes * 60 + seconds) * whole + frames - dropped * (minutes - minutes // 10)
