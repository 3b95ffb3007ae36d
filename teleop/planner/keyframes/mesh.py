"""Where a segment's intervals are cut into pieces.

Evenly, except beside a much shorter interval: there the cuts are graded, so that neighboring pieces never differ so
much in duration that one knot could not serve both (`qp` scales its unknowns by the shorter one).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from teleop.planner.polynomial import Array

Indices = NDArray[np.intp]

GRADE = 4.0  # largest ratio of neighboring pieces where keys of very different spacing meet


def mesh(durations: Array, pieces: int) -> tuple[Indices, Array, Indices]:
    """Each piece's interval (m,) and width (m,), and the knot of each key (n + 1,)."""
    equal = durations / pieces
    before = np.concatenate([equal[:1], equal[:-1]])
    after = np.concatenate([equal[1:], equal[-1:]])
    widths = []
    for whole, width, left, right in zip(durations, equal, before, after, strict=True):
        inner = width * np.arange(1, pieces)
        graded = [*_grading(left, width), *(whole - x for x in _grading(right, width))]
        widths.append(np.diff(np.unique(np.concatenate([[0.0], inner, graded, [whole]]))))
    counts = [len(w) for w in widths]
    return np.repeat(np.arange(len(durations)), counts), np.concatenate(widths), np.cumsum([0, *counts])


def _grading(neighbor: float, width: float) -> list[float]:
    """Distances from a key at which to cut a piece of `width` beside one of `neighbor`."""
    cuts = []
    cut = GRADE * neighbor
    while cut * 2 < width:
        cuts.append(cut)
        cut *= GRADE
    return cuts
