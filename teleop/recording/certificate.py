"""How exactly the passes of a move were repeated: against the plan and against the first, at the keys and between."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis
from teleop.planner.polynomial import Array
from teleop.recording.passes import Pass, Path1, passes
from teleop.recording.played import SAME
from teleop.recording.reader import Take

AT_KEY = 0.03  # s: a reading that near to a key does not count as between keys
EDGE = 0.06  # s: a key that near to the first or the last reading is met by it


@dataclass(frozen=True)
class Spread:
    """`rms` and `peak` in units, of `count` values; `at` is when in the move the peak is, in s."""

    count: int
    rms: float
    peak: float
    at: float


@dataclass(frozen=True)
class Comparison:
    """All readings, what there is at the keys, and the readings between; None without any."""

    all: Spread
    keys: Spread | None
    between: Spread | None


@dataclass(frozen=True)
class AxisResult:
    """One axis of one pass; `first` is None for the first pass, and where that has no reading at the same times."""

    plan: Comparison
    first: Comparison | None


@dataclass(frozen=True, eq=False)
class Certificate:
    """`results` has the measured axes of each pass; `keys` the times of the keys by axis, empty where not known."""

    takes: Sequence[Take]
    passes: Sequence[Pass]
    results: Sequence[Mapping[Axis, AxisResult]]
    axes: Sequence[Axis]
    keys: Mapping[Axis, Sequence[float]]

    @property
    def measured(self) -> Sequence[Axis]:
        return [axis for axis in self.axes if any(axis in of_pass for of_pass in self.results)]

    @property
    def end(self) -> float:
        """The time of the last key in s, inf where that is not known."""
        return last_key(self.keys)

    @property
    def fingerprint(self) -> str:
        """Of the sequence; "" where the takes do not have it."""
        return self.takes[0].about.sequence.fingerprint


def last_key(keys: Mapping[Axis, Sequence[float]]) -> float:
    """In s; inf where there is none."""
    return max((time for times in keys.values() for time in times), default=math.inf)


def certify(takes: Sequence[Take]) -> Certificate:
    """Raises UnplayableError for takes of different moves or rigs, and where nothing was measured."""
    first = takes[0]
    for take in takes[1:]:
        if take.about.rig != first.about.rig:
            raise UnplayableError([f"{take.path}: was played on {take.about.rig}, {first.path} on {first.about.rig}"])
        mine, others = take.about.sequence.fingerprint, first.about.sequence.fingerprint
        if mine != others or (not mine and take.about.title != first.about.title):
            raise UnplayableError([f"{take.path}: plays another move than {first.path}"])
    found = [each for take in takes for each in passes(take)]
    if not found:
        raise UnplayableError([f"{first.path}: has no pass: the run ended before the move began"])
    axes, keys = first.axes, first.about.sequence.keys
    end = last_key(keys)
    results = [
        {
            axis: result
            for axis in axes
            if axis in each.measured
            if (result := _result(each, found[0], axis, np.array(keys.get(axis, ())), end)) is not None
        }
        for each in found
    ]
    if not any(results):
        raise UnplayableError([f"{first.path}: no axis was measured in any pass"])
    return Certificate(takes, found, results, axes, keys)


def _result(each: Pass, first: Pass, axis: Axis, keys: Array, end: float) -> AxisResult | None:
    times, positions = _within(each.measured[axis], end)
    plan = _compared(times, np.interp(times, *each.planned[axis]) - positions, keys)
    if plan is None:
        return None
    against = None
    if each is not first and axis in first.measured:
        theirs, then = _within(first.measured[axis], end)
        within = (times >= theirs[:1].min(initial=np.inf)) & (times <= theirs[-1:].max(initial=-np.inf))
        apart = positions[within] - np.interp(times[within], theirs, then) if within.any() else np.empty(0)
        against = _compared(times[within], apart, keys)
    return AxisResult(plan, against)


def _within(path: Path1, end: float) -> Path1:
    """From the move's zero to its end: a corrected pass begins earlier and lasts longer."""
    times, positions = path
    during = (times >= -SAME) & (times <= end + SAME)
    return times[during], positions[during]


def _compared(times: Array, errors: Array, keys: Array) -> Comparison | None:
    whole = _spread(times, errors)
    if whole is None:
        return None
    met = keys[(keys >= times[0] - EDGE) & (keys <= times[-1] + EDGE)]
    apart = np.ones(len(times), dtype=bool)
    for key in met.tolist():
        apart &= np.abs(times - key) > AT_KEY
    at_keys = _spread(met, np.interp(met, times, errors))
    return Comparison(whole, at_keys, _spread(times[apart], errors[apart]) if len(met) else None)


def _spread(times: Array, errors: Array) -> Spread | None:
    if not len(times):
        return None
    worst = int(np.abs(errors).argmax())
    return Spread(len(times), float(np.sqrt(np.mean(errors**2))), float(abs(errors[worst])), float(times[worst]))


def error_path(each: Pass, axis: Axis, end: float) -> Path1:
    """Planned less measured of an axis, at its readings up to `end` (s)."""
    times, positions = _within(each.measured[axis], end)
    return times, np.interp(times, *each.planned[axis]) - positions
