"""Timecode as it is read, whatever it came by: a frame number, and when that frame began. Pure."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from teleop.config.frame_rates import DROPPED, exact, frame_of, is_dropped

Label = tuple[int, int, int, int]
HOURS = 24


class Reading(NamedTuple):
    """The frame with this label began at `time` (s). `whole`: numbers in a second, 0 where the code does not tell."""

    time: float
    label: Label
    drop: bool
    whole: int = 0


class Fault(NamedTuple):
    """Why what comes is no timecode that can be followed."""

    why: str


def frame(label: Label, whole: int, drop: bool) -> int:
    """The number of a frame from 00:00:00:00 on."""
    return frame_of(label, whole, DROPPED.get(whole, 0) if drop else 0)


def is_label(label: Label, whole: int, drop: bool) -> bool:
    """Whether there is such a frame."""
    hours, minutes, seconds, frames = label
    dropped = DROPPED.get(whole, 0) if drop else 0
    in_range = hours < HOURS and minutes < 60 and seconds < 60 and frames < whole
    return in_range and not is_dropped(minutes, seconds, frames, dropped)


def day(whole: int, drop: bool) -> int:
    """Frames until it begins again."""
    return frame((HOURS, 0, 0, 0), whole, drop)


def wrapped(frames: float, whole: int, drop: bool) -> float:
    """A difference of frames as the shorter way round the day."""
    around = day(whole, drop)
    return (frames + around / 2) % around - around / 2


def exact_fps(rate: float | None, whole: int, drop: bool) -> Fraction:
    """Frames per second: as the profile says, or as the code does."""
    if rate is not None:
        return exact(rate)
    return Fraction(30000, 1001) if drop else Fraction(whole)
