"""When a whole move rests: where something else may be done, or waited for, without an axis being on its way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf
from typing import NamedTuple

from teleop.core.timing import SAME_TIME
from teleop.planner.trajectory import Move, Track

AT_REST = 1e-6  # units per s and per s2: what a solver leaves of a 0


class Rest(NamedTuple):
    """From one time to another, in s; they are the same where the move only comes to rest and goes on."""

    start: float
    end: float


def rests(move: Move) -> list[Rest]:
    """Every time at which all axes of the move rest, in order; the first begins at -inf, the last ends at inf."""
    common = [Rest(-inf, inf)]
    for track in move.tracks.values():
        common = list(_both(common, _of(track)))
    return common


def _of(track: Track) -> list[Rest]:
    """Pieces without motion, joined; and the breaks at which there is neither velocity nor acceleration."""
    breaks: list[float] = track.breaks.tolist()
    ends = [*breaks[1:], breaks[-1]]
    still = [not any(piece[1:]) for piece in track.coefficients.tolist()]
    stopped = [abs(piece[1]) < AT_REST and abs(piece[2]) < AT_REST for piece in track.coefficients.tolist()]
    pieces = [Rest(-inf, breaks[0])]
    pieces += [Rest(breaks[i], ends[i] if still[i] else breaks[i]) for i in range(len(still)) if stopped[i]]
    pieces.append(Rest(breaks[-1], inf))
    joined = pieces[:1]
    for piece in pieces[1:]:
        if piece.start <= joined[-1].end:
            joined[-1] = Rest(joined[-1].start, max(joined[-1].end, piece.end))
        else:
            joined.append(piece)
    return joined


def _both(one: Sequence[Rest], other: Sequence[Rest]) -> Iterator[Rest]:
    """What is in both; each in order, none touching the next."""
    i = j = 0
    while i < len(one) and j < len(other):
        start, end = max(one[i].start, other[j].start), min(one[i].end, other[j].end)
        if start <= end + SAME_TIME:
            yield Rest(start, max(start, end))
        if one[i].end < other[j].end:
            i += 1
        else:
            j += 1
