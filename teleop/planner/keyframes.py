"""Timed keys to a checked move, per axis.

Rests (first and last key, stops, dwells) cut an axis into legs that know nothing of each other, and each leg is a
minimum-jerk programme (`quadratic`). A ladder of rules keeps the common case cheap and the hard one possible: few
pieces first, then finer ones, each with the rule that nothing overshoots; only then without it, and the overshoot is
reported; at last `explain` says what is in the way. Between equal keys without overshoot there is only standing still,
so these too are rests as long as that rule holds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.motion import Axis, Limits
from teleop.planner.explain import explain
from teleop.planner.findings import Finding, Infeasible, PlanError
from teleop.planner.move import Move, Overshoot, Track
from teleop.planner.polynomial import Array, extremes
from teleop.planner.quadratic import HEADROOM, Leg, Rule, solve

PIECES = (2, 4, 8)
STRETCH = 0.002  # relative, of the least factor
MOST = 2.0**20  # times longer: what is impossible then is so at any speed
VISIBLE = 1e-3  # units: what passes a key by less is met


@dataclass(frozen=True, slots=True)
class Key:
    """Be at `position` (units) at `at` (s); `stop` there, for `hold` s. `where` names it in its file."""

    at: float
    position: float
    stop: bool = False
    hold: float = 0.0
    where: str = ""


class _Waypoint(NamedTuple):
    time: float
    position: float
    rest: bool
    where: str


class _Outcome(NamedTuple):
    """One axis planned: its track unless there are unsolved legs, each with the names of its keys."""

    track: Track | None
    overshoots: list[Overshoot]
    unsolved: list[tuple[Leg, list[str]]]


class _Pieces(NamedTuple):
    widths: Array
    coefficients: Array


def plan(keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: float = 0.0) -> Move:
    """The smoothest move through `keys` (at least one per axis, in order of time) within `limits`.

    First and last key of an axis are stops. `tension` 0 is smoothest, 1 closest to constant speed between keys.
    Raises Infeasible with the findings of all axes, and PlanError where keys are not in order.
    """
    beyond = {axis: _beyond(axis, of_axis, limits[axis]) for axis, of_axis in keys.items()}
    outcomes = {
        axis: _plan_axis(axis, of_axis, limits[axis], tension) for axis, of_axis in keys.items() if not beyond[axis]
    }
    findings = [finding for of_axis in beyond.values() for finding in of_axis]
    for axis, outcome in outcomes.items():
        for leg, wheres in outcome.unsolved:
            findings += explain(axis, leg, wheres, limits[axis])
    if findings:
        raise Infeasible(findings)
    return _assemble(outcomes)


def stretch(
    keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: float = 0.0
) -> tuple[Move, float]:
    """The move with all its times, dwells included, longer by the least factor (>= 1) that makes it possible.

    Exact to STRETCH. Raises as `plan` does what more time cannot mend.
    """
    low = high = 1.0
    move = _attempt(keys, limits, tension, high)
    while move is None:
        low, high = high, high * 2
        if high > MOST:
            plan(keys, limits, tension)
        move = _attempt(keys, limits, tension, high)
    while high > low * (1 + STRETCH):
        middle = (low * high) ** 0.5
        shorter = _attempt(keys, limits, tension, middle)
        low, high, move = (middle, high, move) if shorter is None else (low, middle, shorter)
    return move, high


def _attempt(
    keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: float, factor: float
) -> Move | None:
    """The move with its times multiplied, None when that is not enough. Raises Infeasible for keys out of reach."""
    outcomes = {}
    for axis, of_axis in keys.items():
        beyond = _beyond(axis, of_axis, limits[axis])
        if beyond:
            raise Infeasible(beyond)
        longer = [replace(key, at=key.at * factor, hold=key.hold * factor) for key in of_axis]
        outcomes[axis] = _plan_axis(axis, longer, limits[axis], tension)
        if outcomes[axis].unsolved:
            return None
    return _assemble(outcomes)


def _assemble(outcomes: Mapping[Axis, _Outcome]) -> Move:
    return Move(
        {axis: outcome.track for axis, outcome in outcomes.items() if outcome.track is not None},
        tuple(overshoot for outcome in outcomes.values() for overshoot in outcome.overshoots),
    )


def _beyond(axis: Axis, keys: Sequence[Key], limits: Limits) -> list[Finding]:
    outside = []
    for key in keys:
        for limit, excess in (("minimum", limits.minimum - key.position), ("maximum", key.position - limits.maximum)):
            if excess > 0:
                outside.append(Finding(axis, key.where, key.where, limit, excess))
    return outside


def _waypoints(axis: Axis, keys: Sequence[Key]) -> list[_Waypoint]:
    """Keys in time, a dwell as two rests. Raises PlanError where one is not after the other."""
    points: list[_Waypoint] = []
    for number, key in enumerate(keys):
        rest = key.stop or key.hold > 0 or number in (0, len(keys) - 1)
        if points and key.at <= points[-1].time:
            last = points[-1]
            if key.at < last.time or key.position != last.position:
                raise PlanError(
                    f"{axis}, {key.where}: at {key.at:.6g} s is not after {last.where}, which ends at {last.time:.6g} s"
                )
            points[-1] = last._replace(rest=True)
        else:
            points.append(_Waypoint(key.at, key.position, rest, key.where))
        if key.hold > 0:
            points.append(_Waypoint(key.at + key.hold, key.position, True, key.where))
    return points


def _plan_axis(axis: Axis, keys: Sequence[Key], limits: Limits, tension: float) -> _Outcome:
    points = _waypoints(axis, keys)
    rests = [i for i, point in enumerate(points) if point.rest]
    overshoots: list[Overshoot] = []
    unsolved: list[tuple[Leg, list[str]]] = []
    breaks: list[Array] = []
    coefficients: list[Array] = [np.empty((0, 6))]
    for first, last in pairwise(rests):
        stretch = points[first : last + 1]
        leg = Leg(np.array([p.time for p in stretch], float), np.array([p.position for p in stretch], float))
        wheres = [p.where for p in stretch]
        pieces = _directed(leg, limits, tension)
        if pieces is None:
            pieces = _undirected(leg, limits, tension)
            if pieces is None:
                unsolved.append((leg, wheres))
                continue
            overshoots += _overshoots(axis, leg, wheres, pieces)
        breaks.append(leg.times[0] + np.concatenate([[0.0], np.cumsum(pieces.widths[:-1])]))
        coefficients.append(pieces.coefficients)
    if unsolved:
        return _Outcome(None, overshoots, unsolved)
    end = points[-1]
    track = Track(np.concatenate([*breaks, [end.time]]), np.concatenate(coefficients), end.position)
    return _Outcome(track, overshoots, unsolved)


def _directed(leg: Leg, limits: Limits, tension: float) -> _Pieces | None:
    """Without overshoot: cut where equal keys follow each other, each part by the coarsest rule that does."""
    if np.any(np.abs(leg.steps) > HEADROOM * limits.velocity * leg.durations):
        return None
    flat = leg.steps == 0
    cuts = (np.flatnonzero(flat[:-1] | flat[1:]) + 1).tolist()
    parts = []
    for first, last in pairwise([0, *cuts, len(flat)]):
        if flat[first]:
            parts.append(_standing(leg, first))
            continue
        part = Leg(leg.times[first : last + 1], leg.positions[first : last + 1])
        rules = (Rule(n, True, tension) for n in PIECES if tension == 0 or n > 2)
        solved = next((pieces for pieces in (solve(part, limits, rule) for rule in rules) if pieces is not None), None)
        if solved is None:
            return None
        parts.append(_Pieces(*solved))
    return _Pieces(np.concatenate([p.widths for p in parts]), np.concatenate([p.coefficients for p in parts]))


def _standing(leg: Leg, segment: int) -> _Pieces:
    return _Pieces(leg.durations[segment : segment + 1], np.array([[leg.positions[segment], 0.0, 0.0, 0.0, 0.0, 0.0]]))


def _undirected(leg: Leg, limits: Limits, tension: float) -> _Pieces | None:
    solved = solve(leg, limits, Rule(PIECES[-1], False, tension))
    return None if solved is None else _Pieces(*solved)


def _overshoots(axis: Axis, leg: Leg, wheres: Sequence[str], pieces: _Pieces) -> list[Overshoot]:
    """By how much each segment leaves the range of its two keys, where that can be seen."""
    least, greatest = extremes(pieces.coefficients, pieces.widths)
    middles = leg.times[0] + np.cumsum(pieces.widths) - pieces.widths / 2
    segment = np.searchsorted(leg.times, middles) - 1
    low = np.minimum(leg.positions[:-1], leg.positions[1:])[segment]
    high = np.maximum(leg.positions[:-1], leg.positions[1:])[segment]
    excess = np.maximum(low - least[0], greatest[0] - high)
    sizes = np.zeros(len(leg.steps))
    np.maximum.at(sizes, segment, excess)
    return [
        Overshoot(axis, wheres[i], wheres[i + 1], float(sizes[i])) for i in np.flatnonzero(sizes > VISIBLE).tolist()
    ]
