"""Where a segment's intervals are cut into pieces.

Evenly, except beside a much shorter interval: there the cuts are graded, so that neighboring pieces never differ so
much in duration that one knot could not serve both (`program` scales its unknowns by the shorter one). And finer at a
key where the motion changes within less time than a piece lasts: how much less is `near`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from teleop.planner.polynomial import Array

Indices = NDArray[np.intp]

GRADE = 4.0  # largest ratio of neighboring pieces where keys of very different spacing meet
LEFT = 0.7  # share of an even piece: no finer cut comes nearer to its end


def mesh(durations: Array, pieces: int | Indices, near: Array | None = None) -> tuple[Indices, Array, Indices]:
    """Each piece's interval (m,) and width (m,), and the knot of each key (n + 1,). `pieces` are of all or of each.

    `near` (n, 2) is the width in s of the piece at each end of an interval, where that is to be less than the others';
    from there to the inside each piece is twice as long as the last.
    """
    equal = durations / pieces
    counted = np.broadcast_to(pieces, len(durations)).tolist()
    before = np.concatenate([equal[:1], equal[:-1]])
    after = np.concatenate([equal[1:], equal[-1:]])
    finest = np.full((len(durations), 2), np.inf) if near is None else near
    widths, counts = [], []
    intervals = np.stack([durations, equal, before, after, *finest.T], axis=1).tolist()
    for count, (whole, width, left, right, near_left, near_right) in zip(counted, intervals, strict=True):
        first, last = _grading(left, width, near_left), _grading(right, width, near_right)
        if not first and not last:
            widths += [width] * count
            counts.append(count)
            continue
        inner = [width * i for i in range(1, count)]
        cuts = sorted({0.0, *inner, *first, *(whole - x for x in last), whole})
        widths += np.diff(cuts).tolist()
        counts.append(len(cuts) - 1)
    return np.repeat(np.arange(len(durations)), counts), np.array(widths), np.cumsum([0, *counts])


def _grading(neighbor: float, width: float, near: float) -> list[float]:
    """Distances from a key at which to cut a piece of `width` beside one of `neighbor`, or beside a change."""
    cuts = []
    if near <= GRADE * neighbor:
        cut = step = near
        while cut < LEFT * width:
            cuts.append(cut)
            step *= 2
            cut += step
        return cuts
    cut = GRADE * neighbor
    while cut * 2 < width:
        cuts.append(cut)
        cut *= GRADE
    return cuts
