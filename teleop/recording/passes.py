"""The passes in a take: what was planned and what was measured, at the move's own time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.polynomial import Array
from teleop.recording.played import NO_PASS, SAME, Mark
from teleop.recording.reader import Take

Path1 = tuple[Array, Array]  # times (n,) in s of the move, rising, and positions (n,) in units


@dataclass(frozen=True, eq=False)
class Pass:
    """One pass of `take`, its `number` there. `remarks` are lines about what is not as it should be."""

    take: Take
    number: int
    planned: Mapping[Axis, Path1]
    measured: Mapping[Axis, Path1]
    corrected: bool
    remarks: Sequence[str]

    @property
    def span(self) -> tuple[float, float]:
        """From when to when in the move it was played, in s."""
        times = next(iter(self.planned.values()))[0]
        return float(times[0]), float(times[-1])


def passes(take: Take) -> Iterator[Pass]:
    """Those of a take in their order; a take that does not say where they begin is one pass, from its first tick."""
    if not len(take.times):
        return
    marks = [*take.marks, Mark(take.duration + SAME, NO_PASS, 0.0)]
    if not take.marks:
        marks.insert(0, Mark(0.0, 1, 0.0))
    for number in sorted({mark.number for mark in marks} - {NO_PASS}):
        parts = [(mark, end.time) for mark, end in pairwise(marks) if mark.number == number]
        yield _pass(take, number, parts)


def _pass(take: Take, number: int, parts: Sequence[tuple[Mark, float]]) -> Pass:
    planned = {axis: _path(take.times, take.planned(axis), parts) for axis in take.axes}
    measured = {axis: _path(rows[0], rows[1], parts) for axis, rows in take.measured.items() if axis in planned}
    measured = {axis: path for axis, path in measured.items() if len(path[0])}
    first = parts[0][0]
    begin, end = (int(each) for each in np.searchsorted(take.times, [first.time - SAME, parts[-1][1] - SAME]))
    corrected = any(
        len(rows[0]) and bool(((rows[0] >= take.times[begin]) & (rows[0] <= take.times[end - 1])).any())
        for rows in take.plan.values()
    )
    return Pass(take, number, planned, measured, corrected, list(_remarks(take, parts)))


def _remarks(take: Take, parts: Sequence[tuple[Mark, float]]) -> Iterator[str]:
    if not take.marks:
        yield "the take does not say where its passes begin: the whole run counts as one, from its first tick"
    if len(parts) > 1:
        yield "it was stopped, paused, or its speed was changed"
    ended = take.ending is None or take.ending.result != "done"
    if ended and parts[-1][1] >= take.duration:
        yield f"the run ended in it: {take.ended}"


def _path(times: Array, positions: Array, parts: Sequence[tuple[Mark, float]]) -> Path1:
    """What lies within the parts of a pass, at the move's own time; a step back along the path is left out."""
    places, found = [], []
    for mark, end in parts:
        within = (times >= mark.time - SAME) & (times < end - SAME)
        places.append(times[within] - mark.time + mark.place)
        found.append(positions[within])
    place, position = np.concatenate(places), np.concatenate(found)
    highest = np.maximum.accumulate(np.concatenate([[-np.inf], place]))[:-1]
    onward = place > highest + SAME
    return place[onward], position[onward]
