"""The median, without numpy's own: that loads numpy.ma, which takes as long as planning a short move."""

from __future__ import annotations

import numpy as np

from teleop.planner.polynomial import Array


def median(values: Array) -> float:
    """The middle one of `values` (n,), or the mean of the two in the middle; at least one."""
    ordered, count = np.sort(values), len(values)
    return float(ordered[(count - 1) // 2] + ordered[count // 2]) / 2
