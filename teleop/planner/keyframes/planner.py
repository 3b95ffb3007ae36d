"""Timed keys to a checked move, axis by axis.

Rests (the first and last key, stops and holds) cut an axis into segments that do not affect each other. Each segment is
a minimum-jerk program, tried with a `ladder` of rules; if none has a solution, `infeasibility` says why.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.bounds import is_beyond
from teleop.planner.keyframes.diagnostics import long_ramps, overshoots, standstills
from teleop.planner.keyframes.findings import (
    Finding,
    Infeasible,
    LongRamp,
    Overshoot,
    Overshooting,
    PlanError,
    Standstill,
)
from teleop.planner.keyframes.keys import Key, ramps_asked, ramps_fit, segment_between, waypoints
from teleop.planner.keyframes.ladder import Overshot, Pieces, directed, is_easy, is_tolerable, overshooting
from teleop.planner.keyframes.legs import Points, legs, shortened
from teleop.planner.keyframes.overshoot import tolerated
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.tension import EVEN, Tension
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Track

STRETCH = 0.002  # relative, of the least factor
MOST = 2.0**20  # times longer: what is impossible then is so at any speed
NEGLIGIBLE = 1e-9  # units


@dataclass
class _Outcome:
    """One axis planned: its track, or else the legs from rest to rest that have no plan, `overshot` ones among them."""

    track: Track | None = None
    remarks: list[Overshoot | LongRamp | Standstill] = field(default_factory=list)
    refused: list[Points] = field(default_factory=list)
    overshot: list[tuple[Points, Overshooting]] = field(default_factory=list)


def plan(keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: Tension = EVEN) -> Move:
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
        from teleop.planner.keyframes.infeasibility import infeasibilities, with_overshoots  # with all that it searches
        from teleop.planner.keyframes.possible import Possible

        def by(judge: Callable[[Segment, Limits, Tension], bool], axis: Axis, points: Points) -> bool:
            segment = _segment_of(axis, points, limits[axis])
            return segment is not None and judge(segment, limits[axis], _evenness(points, tension))

        def planned(axis: Axis, points: Points) -> bool:
            return _plan_leg(axis, points, limits[axis], tension, False, _Outcome()) is not None

        within = {axis: keys[axis] for axis in outcomes}
        possible = Possible(limits, partial(by, is_easy), partial(by, is_tolerable), planned, refused)
        found = infeasibilities(within, limits, refused, possible) if refused else []
        overshot = [leg for outcome in outcomes.values() for leg in outcome.overshot]
        outside = [finding for of_axis in beyond.values() for finding in of_axis]
        raise Infeasible([*outside, *with_overshoots(found, overshot)])
    return _assemble(outcomes)


def stretch(
    keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: Tension = EVEN
) -> tuple[Move, float]:
    """The move with all its times, dwells included, longer by the least factor (>= 1) that makes it possible.

    A move that has to be longer has no overshoot.
    Exact to STRETCH. Raises as `plan` does what more time cannot mend.
    """
    low = high = 1.0
    move = _attempt(keys, limits, tension, high)
    while move is None:
        low, high = high, high * 2
        if high > MOST:
            plan(keys, limits, tension)
        move = _attempt(keys, limits, tension, high, clean=True)
    while high > low * (1 + STRETCH):
        middle = (low * high) ** 0.5
        shorter = _attempt(keys, limits, tension, middle, clean=True)
        low, high, move = (middle, high, move) if shorter is None else (low, middle, shorter)
    return move, high


def attempt(keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: Tension = EVEN) -> Move | None:
    """What `plan` gives, or None where it raises Infeasible: for a search that tries many keys and needs no reasons."""
    try:
        return _attempt(keys, limits, tension, 1.0)
    except Infeasible:
        return None


def _attempt(
    keys: Mapping[Axis, Sequence[Key]],
    limits: Mapping[Axis, Limits],
    tension: Tension,
    factor: float,
    clean: bool = False,
) -> Move | None:
    """The move with its times multiplied, None when that is not enough. Raises Infeasible for keys out of reach.

    A `clean` one has no overshoot at all.
    """
    outcomes = {}
    for axis, of_axis in keys.items():
        beyond = _beyond(axis, of_axis, limits[axis])
        if beyond:
            raise Infeasible(beyond)
        later = [key.later(factor) for key in of_axis]
        outcomes[axis] = _plan_axis(axis, later, limits[axis], tension, clean)
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
    remarks = [remark for outcome in outcomes.values() for remark in outcome.remarks]
    return Move(
        tracks,
        tuple(remark for remark in remarks if isinstance(remark, Overshoot)),
        tuple(remark for remark in remarks if isinstance(remark, LongRamp)),
        tuple(remark for remark in remarks if isinstance(remark, Standstill)),
    )


def _beyond(axis: Axis, keys: Sequence[Key], limits: Limits) -> list[Finding]:
    outside = []
    for key in keys:
        for limit, excess in (("minimum", limits.minimum - key.position), ("maximum", key.position - limits.maximum)):
            if excess > 0:
                outside.append(Finding(axis, key.where, key.where, limit, excess))
    return outside


def _plan_axis(axis: Axis, keys: Sequence[Key], limits: Limits, tension: Tension, clean: bool = False) -> _Outcome:
    outcome = _Outcome()
    breaks: list[Array] = []
    coefficients: list[Array] = [np.empty((0, 6))]
    for points in legs(axis, keys):
        few, _ = shortened(points)
        trial = _Outcome()
        pieces = None
        if len(few) == len(points) or _plan_leg(axis, few, limits, tension, clean, trial) is not None:
            pieces = _plan_leg(axis, points, limits, tension, clean, outcome)
        if pieces is None:
            outcome.refused.append(points)
            outcome.overshot += trial.overshot
        else:
            breaks.append(pieces.begin(np.array([point.time for point in points])))
            coefficients.append(pieces.coefficients)
    if not outcome.refused:
        end = waypoints(axis, keys)[-1]
        outcome.track = Track(np.concatenate([*breaks, [end.time]]), np.concatenate(coefficients), end.position)
    return outcome


def _plan_leg(
    axis: Axis, points: Points, limits: Limits, tension: Tension, clean: bool, outcome: _Outcome
) -> Pieces | None:
    """The pieces from one rest to the next, None where there is no plan. Adds to `outcome` its remarks."""
    segment = _segment_of(axis, points, limits)
    if segment is None:
        return None
    names, asked, evenness = [point.where for point in points], ramps_asked(points), _evenness(points, tension)
    pieces = directed(segment, limits, evenness)
    if pieces is None and not clean:
        found = overshooting(segment, limits, evenness)
        if isinstance(found, Overshot):
            outcome.overshot.append((points, _overshooting(axis, segment, names, found)))
            return None
        if found is not None:
            outcome.remarks += overshoots(axis, segment, names, *found)
        pieces = found
    if pieces is None:
        return None
    outcome.remarks += standstills(axis, segment, names, *pieces)
    outcome.remarks += [] if asked is None else long_ramps(axis, segment, names, asked)
    return pieces


def _segment_of(axis: Axis, points: Points, limits: Limits) -> Segment | None:
    """From one rest to the next, with its ramps and tolerances; None where the bounds know that it has no plan."""
    if not ramps_fit(points):
        return None
    segment = segment_between(points, ramps_asked(points), limits)
    if is_beyond(segment, limits):
        return None
    return replace(segment, stray=tolerated(axis, segment, [point.overshoot for point in points[:-1]]))


def _evenness(points: Points, tension: Tension) -> Tension:
    return tension if points[0].tension is None else points[0].tension


def _overshooting(axis: Axis, segment: Segment, names: Sequence[str], overshot: Overshot) -> Overshooting:
    """The largest overshoot of a segment."""
    interval = int(np.argmax(overshot.least / np.maximum(segment.strays(directed=False), NEGLIGIBLE)))
    return Overshooting(axis, names[interval], names[interval + 1], float(overshot.least.max()))
