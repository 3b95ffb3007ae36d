"""The keys of several axes as keyframes: one line for all that are at the same time.

A stop or a hold in a line applies to all of its axes. So a line has a hold only where all of them hold as long; a
longer or shorter one is written as a second stop at its end. A key that is passed through and meets another axis's stop
moves on by a hundredth of a second, along the recording.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from teleop.core.axes import Axis
from teleop.recording.to_keyframes.reference import Reference

BRIEF = 5  # places: a rest at the very end that is shorter is not worth a hold


class AxisKey(NamedTuple):
    """One axis at a place of the grid: units, and for how many places it holds; None: it is passed through."""

    place: int
    position: float
    hold: int | None = None


@dataclass(frozen=True)
class MergedKey:
    """A line of a sequence: `place` and `hold` in hundredths of a second, positions in units."""

    place: int
    positions: Mapping[Axis, float]
    stop: bool = False
    hold: int = 0


def merge_keys(keys: Mapping[Axis, Sequence[AxisKey]], references: Mapping[Axis, Reference]) -> Sequence[MergedKey]:
    """The keyframes, rising in time. An axis's first and last key stop by themselves, and the last may hold at will."""
    ends = {axis: (of_axis[0].place, of_axis[-1].place) for axis, of_axis in keys.items()}
    rests: Rests = {}
    for axis, of_axis in keys.items():
        for key in of_axis:
            if key.hold is not None:
                rests.setdefault(key.place, {})[axis] = key
    holds = _common_holds(rests, {axis: last for axis, (_, last) in ends.items()})
    lines = {}
    for place, of_place in rests.items():
        inner = any(place not in ends[axis] for axis in of_place)
        positions = {axis: key.position for axis, key in of_place.items()}
        lines[place] = MergedKey(place, positions, inner and holds[place] == 0, holds[place])
    for axis, of_axis in keys.items():
        for place, position in _moved_on(of_axis, rests, references[axis]):
            line = lines.get(place, MergedKey(place, {}))
            lines[place] = replace(line, positions={**line.positions, axis: position})
    return [lines[place] for place in sorted(lines)]


Rests = dict[int, dict[Axis, AxisKey]]


def _common_holds(rests: Rests, last: Mapping[Axis, int]) -> Mapping[int, int]:
    """The hold of each line of rests, once the holds that not all of its axes have are stops at both ends."""
    begun = sorted(rests)
    while begun:
        place = begun.pop(0)
        holding = {axis: key for axis, key in rests[place].items() if place != last[axis]}
        if len({key.hold for key in holding.values()}) <= 1:
            continue
        for axis, key in holding.items():
            rests[place][axis] = key._replace(hold=0)
            if key.hold:
                end = place + key.hold
                rests.setdefault(end, {})[axis] = AxisKey(end, key.position, 0)
                begun.append(end)
    final = max(rests)
    holds = {}
    for place, of_place in rests.items():
        asked = [key.hold or 0 for axis, key in of_place.items() if place != last[axis]]
        at_end = max((key.hold or 0 for key in of_place.values()), default=0) if place == final else 0
        holds[place] = asked[0] if asked else at_end if at_end > BRIEF else 0
    return holds


def _moved_on(keys: Sequence[AxisKey], rests: Rests, reference: Reference) -> Iterator[tuple[int, float]]:
    """The keys that are passed through, where no other axis stops."""
    taken = {key.place for key in keys}
    for place, position, hold in keys:
        if hold is not None:
            continue
        free = place
        while free in rests or (free != place and free in taken):
            free += 1
        moved = float(reference.positions[free] - reference.positions[place])
        yield free, position + moved
