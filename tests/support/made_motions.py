"""Paths made by hand for the formats of other programs, and files of them."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from teleop.core.axes import Axis
from teleop.interchange.motion import Motion, TimedCue
from teleop.interchange.table import BY_NAME, WriteOptions

NTSC = Fraction(24000, 1001)
CUES = [TimedCue(0.0, {"camera": "record"}), TimedCue(1.5, {"wait": "operator"}), TimedCue(3.0, {"camera": "stop"})]


def made_motion(count: int = 97, rate: Fraction = NTSC, *, by_time: bool = False, focus: bool = True) -> Motion:
    """Through more than a turn, over straight up and with a roll; `by_time`: at readings that are no frames."""
    times = np.arange(count) / float(rate)
    if by_time:
        times = times + 0.004 * np.sin(np.arange(count) * 1.7)
        times -= times[0]
    share = np.linspace(0, 1, count)
    positions = {
        Axis.PAN: 190.0 + 250.0 * share**2,
        Axis.TILT: -30.0 + 55.5 * np.sin(3 * share),
        Axis.ROLL: 12.345678 * np.cos(5 * share),
    }
    if focus:
        positions[Axis.FOCUS] = 0.2 + 0.6 * share
    return Motion("Hand & 'made' \"path\"", times, positions, rate, 1001, CUES, "made.yaml", "planned")


def content(name: str, motion: Motion, axes: Sequence[Axis] | None = None) -> bytes:
    """A file of the format called `name`."""
    form = BY_NAME[name]
    carried = [axis for axis in form.carries if axis in motion.positions]
    return form.load().write(motion, WriteOptions(None, axes or carried))
