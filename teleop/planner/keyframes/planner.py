"""Timed keys to a checked move, axis by axis.

Rests (the first and last key, stops and holds) cut an axis into segments that do not affect each other. Each segment is
a minimum-jerk program (`qp`), tried with a ladder of rules: few pieces first, then more, all without overshoot; then
with overshoot, which is reported as a warning; if none has a solution, `infeasibility` says why. Two equal keys next to
each other are a rest as long as no overshoot is allowed, because the axis can only stand still between them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.bounds import is_beyond
from teleop.planner.keyframes.diagnostics import long_ramps, overshoots
from teleop.planner.keyframes.findings import (
    Finding,
    Infeasible,
    LongRamp,
    Overshoot,
    PlanError,
)
from teleop.planner.keyframes.infeasibility import infeasibilities
from teleop.planner.keyframes.keys import Key, Waypoint, ramps_asked, ramps_fit, segment_between, waypoints
from teleop.planner.keyframes.legs import legs, shortened
from teleop.planner.keyframes.qp import HEADROOM, Rule, solve
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Track

PIECES = (2, 4, 8)
STRETCH = 0.002  # relative, of the least factor
MOST = 2.0**20  # times longer: what is impossible then is so at any speed


class _Outcome(NamedTuple):
    """One axis planned: its track, or else the legs from rest to rest that have no plan."""

    track: Track | None
    overshoots: list[Overshoot]
    long_ramps: list[LongRamp]
    refused: list[Sequence[Waypoint]]


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
    refused = {axis: outcome.refused for axis, outcome in outcomes.items() if outcome.refused}
    if refused or any(beyond.values()):

        def possible(axis: Axis, points: Sequence[Waypoint]) -> bool:
            return _plan_leg(axis, points, limits[axis], tension, _Outcome(None, [], [], [])) is not None

        within = {axis: keys[axis] for axis in outcomes}
        found = infeasibilities(within, limits, refused, possible) if refused else []
        raise Infeasible([*(finding for of_axis in beyond.values() for finding in of_axis), *found])
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


def attempt(keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: float = 0.0) -> Move | None:
    """What `plan` gives, or None where it raises Infeasible: for a search that tries many keys and needs no reasons."""
    try:
        return _attempt(keys, limits, tension, 1.0)
    except Infeasible:
        return None


def _attempt(
    keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: float, factor: float
) -> Move | None:
    """The move with its times multiplied, None when that is not enough. Raises Infeasible for keys out of reach."""
    outcomes = {}
    for axis, of_axis in keys.items():
        beyond = _beyond(axis, of_axis, limits[axis])
        if beyond:
            raise Infeasible(beyond)
        outcomes[axis] = _plan_axis(axis, [key.later(factor) for key in of_axis], limits[axis], tension)
        if not all(map(ramps_fit, outcomes[axis].refused)):
            plan(keys, limits, tension)  # however long the move, its ramps take the same share: raises with the reason
        if outcomes[axis].refused:
            return None
    return _assemble(outcomes)


def _assemble(outcomes: Mapping[Axis, _Outcome]) -> Move:
    tracks = {axis: outcome.track for axis, outcome in outcomes.items() if outcome.track is not None}
    if missing := [axis for axis in outcomes if axis not in tracks]:
        raise PlanError(
            f"{', '.join(missing)}: the planner gave neither a plan nor a reason; please report this file"
        )  # an axis is never left out in silence
    return Move(
        tracks,
        tuple(overshoot for outcome in outcomes.values() for overshoot in outcome.overshoots),
        tuple(ramp for outcome in outcomes.values() for ramp in outcome.long_ramps),
    )


def _beyond(axis: Axis, keys: Sequence[Key], limits: Limits) -> list[Finding]:
    outside = []
    for key in keys:
        for limit, excess in (("minimum", limits.minimum - key.position), ("maximum", key.position - limits.maximum)):
            if excess > 0:
                outside.append(Finding(axis, key.where, key.where, limit, excess))
    return outside


def _plan_axis(axis: Axis, keys: Sequence[Key], limits: Limits, tension: float) -> _Outcome:
    outcome = _Outcome(None, [], [], [])
    breaks: list[Array] = []
    coefficients: list[Array] = [np.empty((0, 6))]
    for points in legs(axis, keys):
        few, _ = shortened(points)
        is_repeated = len(few) < len(points)
        pieces = None
        if not is_repeated or _plan_leg(axis, few, limits, tension, _Outcome(None, [], [], [])) is not None:
            pieces = _plan_leg(axis, points, limits, tension, outcome)
        if pieces is None:
            outcome.refused.append(points)
        else:
            breaks.append(points[0].time + np.concatenate([[0.0], np.cumsum(pieces.widths[:-1])]))
            coefficients.append(pieces.coefficients)
    if outcome.refused:
        return outcome
    end = waypoints(axis, keys)[-1]
    track = Track(np.concatenate([*breaks, [end.time]]), np.concatenate(coefficients), end.position)
    return outcome._replace(track=track)


def _plan_leg(
    axis: Axis, points: Sequence[Waypoint], limits: Limits, tension: float, outcome: _Outcome
) -> _Pieces | None:
    """The pieces from one rest to the next, None where there is no plan. Adds its warnings to `outcome`."""
    names, asked = [point.where for point in points], ramps_asked(points)
    if not ramps_fit(points):
        return None
    segment = segment_between(points, asked, limits)
    if is_beyond(segment, limits):
        return None
    evenness = tension if points[0].tension is None else points[0].tension
    pieces = _directed(segment, limits, evenness)
    if pieces is None:
        pieces = _undirected(segment, limits, evenness)
        if pieces is None:
            return None
        outcome.overshoots.extend(overshoots(axis, segment, names, *pieces))
    if asked:
        outcome.long_ramps.extend(long_ramps(axis, segment, names, asked))
    return pieces


def _directed(segment: Segment, limits: Limits, tension: float) -> _Pieces | None:
    """Without overshoot: cut where equal keys follow each other, each part by the coarsest rule that does."""
    if np.any(np.abs(segment.steps) > HEADROOM * limits.velocity * segment.durations):
        return None
    flat = segment.steps == 0
    cuts = (np.flatnonzero(flat[:-1] | flat[1:]) + 1).tolist()
    parts = []
    for first, last in pairwise([0, *cuts, len(flat)]):
        if flat[first]:
            parts.append(_standing(segment, first))
            continue
        part = segment.part(first, last)
        rules = (Rule(n, True, tension) for n in PIECES if tension == 0 or n > 2)
        solved = next((pieces for pieces in (solve(part, limits, rule) for rule in rules) if pieces is not None), None)
        if solved is None:
            return None
        parts.append(_Pieces(*solved))
    return _Pieces(np.concatenate([p.widths for p in parts]), np.concatenate([p.coefficients for p in parts]))


def _standing(segment: Segment, interval: int) -> _Pieces:
    return _Pieces(
        segment.durations[interval : interval + 1], np.array([[segment.positions[interval], 0.0, 0.0, 0.0, 0.0, 0.0]])
    )


def _undirected(segment: Segment, limits: Limits, tension: float) -> _Pieces | None:
    solved = solve(segment, limits, Rule(PIECES[-1], False, tension))
    return None if solved is None else _Pieces(*solved)
