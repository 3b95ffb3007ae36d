"""A move as CSV, for spreadsheets and other people's programs.

Made chunk by chunk from the polynomials, so a day at 100 Hz takes the memory of a second. Times are written so that
they read back as the same numbers; ten digits of everything else are finer than any encoder.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.polynomial import Array
from teleop.plots.downsample import QUANTITIES


def header(axes: Sequence[Axis]) -> str:
    """`time` in seconds, then per axis its position, velocity, acceleration and jerk, in units and per s, s2, s3."""
    names = [f"{axis}_{quantity}" if row else f"{axis}" for axis in axes for row, quantity in enumerate(QUANTITIES)]
    return ",".join(["time", *names]) + "\n"


def lines(chunks: Iterable[tuple[Array, dict[Axis, Array]]]) -> Iterator[str]:
    """The rows below the header, the text of one chunk of `Move.chunks` at a time."""
    for times, samples in chunks:
        pattern = ",".join(["%r", *["%.10g"] * (len(QUANTITIES) * len(samples))]) + "\n"
        rows = np.vstack([times, *samples.values()]).T
        yield "".join([pattern % tuple(row) for row in rows.tolist()])
