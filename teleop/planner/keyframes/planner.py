"""Timed keys to a checked move, axis by axis.

Rests (the first and last key, stops and holds) cut an axis into segments that do not affect each other. Each segment is
a minimum-jerk program, tried with a `ladder` of rules; if none has a solution, `infeasibility` says why.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.diagnostics import long_ramps, overshoots, standstills
from teleop.planner.keyframes.findings import (
    Finding,
    Infeasible,
    LongRamp,
    Overshoot,
    Overshooting,
    PlanError,
    RampsTooLong,
    Standstill,
    Unsolved,
)
from teleop.planner.keyframes.infeasibility import infeasibilities
from teleop.planner.keyframes.keys import Key, Waypoint, ramps_asked, segment_between, waypoints
from teleop.planner.keyframes.ladder import Overshot, Pieces, directed, overshooting
from teleop.planner.keyframes.overshoot import tolerated
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.tension import EVEN, Tension
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Track

STRETCH = 0.002  # relative, of the least factor
MOST = 2.0**20  # times longer: what is impossible then is so at any speed
NEGLIGIBLE = 1e-9  # units
ROUNDING = 1e-9  # relative, of ramps that are to take all of a segment


@dataclass
class _Outcome:
    """One axis planned: its track, unless something is in the way. A segment comes with the names of its keys."""

    track: Track | None = None
    remarks: list[Overshoot | LongRamp | Standstill] = field(default_factory=list)
    unsolved: list[tuple[Segment, list[str]]] = field(default_factory=list)
    overshot: list[tuple[Segment, list[str], Overshot]] = field(default_factory=list)
    too_long: list[RampsTooLong] = field(default_factory=list)

    @property
    def refused(self) -> bool:
        return bool(self.unsolved or self.overshot or self.too_long)


def plan(keys: Mapping[Axis, Sequence[Key]], limits: Mapping[Axis, Limits], tension: Tension = EVEN) -> Move:
    """The smoothest move through `keys` (at least one per axis, in order of time) within `limits`.

    First and last key of an axis are stops. `tension` 0 is smoothest, 1 closest to constant speed between keys.
    Raises Infeasible with the findings of all axes, and PlanError where keys are not in order.
    """
    beyond = {axis: _beyond(axis, of_axis, limits[axis]) for axis, of_axis in keys.items()}
    outcomes = {
        axis: _plan_axis(axis, of_axis, limits[axis], tension) for axis, of_axis in keys.items() if not beyond[axis]
    }
    findings: list[Finding | RampsTooLong | Unsolved | Overshooting] = []
    for of_axis in beyond.values():
        findings += of_axis
    for axis, outcome in outcomes.items():
        findings += outcome.too_long
        for segment, names in outcome.unsolved:
            findings += infeasibilities(axis, segment, names, limits[axis]) or [Unsolved(axis, names[0], names[-1])]
        for segment, names, overshot in outcome.overshot:
            findings += _overshoots(axis, segment, names, overshot, limits[axis])
    if findings:
        raise Infeasible(findings)
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
        if outcomes[axis].too_long:
            raise Infeasible(outcomes[axis].too_long)  # however long the move, its ramps take the same share
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
    points = waypoints(axis, keys)
    rests = [i for i, point in enumerate(points) if point.rest]
    outcome = _Outcome()
    breaks: list[Array] = []
    coefficients: list[Array] = [np.empty((0, 6))]
    for first, last in pairwise(rests):
        pieces = _plan_segment(axis, points[first : last + 1], limits, tension, clean, outcome)
        if pieces is not None:
            breaks.append(points[first].time + np.concatenate([[0.0], np.cumsum(pieces.widths[:-1])]))
            coefficients.append(pieces.coefficients)
    if not outcome.refused:
        end = points[-1]
        outcome.track = Track(np.concatenate([*breaks, [end.time]]), np.concatenate(coefficients), end.position)
    return outcome


def _plan_segment(
    axis: Axis, points: Sequence[Waypoint], limits: Limits, tension: Tension, clean: bool, outcome: _Outcome
) -> Pieces | None:
    """The pieces from one rest to the next. Adds to `outcome` its remarks, or, where this is None, why."""
    names, asked = [point.where for point in points], ramps_asked(points)
    duration = points[-1].time - points[0].time
    if asked is not None and asked[0, 1] + asked[-1, 0] > duration * (1 + ROUNDING):
        outcome.too_long.append(RampsTooLong(axis, names[0], names[-1], asked[0, 1], asked[-1, 0], duration))
        return None
    segment = segment_between(points, asked, limits)
    segment = replace(segment, stray=tolerated(axis, segment, [point.overshoot for point in points[:-1]]))
    evenness = tension if points[0].tension is None else points[0].tension
    pieces = directed(segment, limits, evenness)
    if pieces is None and not clean:
        found = overshooting(segment, limits, evenness)
        if isinstance(found, Overshot):
            outcome.overshot.append((segment, names, found))
            return None
        if found is not None:
            outcome.remarks += overshoots(axis, segment, names, *found)
        pieces = found
    if pieces is None:
        outcome.unsolved.append((segment, names))
        return None
    outcome.remarks += standstills(axis, segment, names, *pieces)
    outcome.remarks += [] if asked is None else long_ramps(axis, segment, names, asked)
    return pieces


def _overshoots(
    axis: Axis, segment: Segment, names: Sequence[str], overshot: Overshot, limits: Limits
) -> list[Overshooting]:
    """The largest overshoot of a segment, with each time that would have to be longer to avoid it."""
    interval = int(np.argmax(overshot.least / np.maximum(segment.strays(directed=False), NEGLIGIBLE)))
    found = Overshooting(axis, names[interval], names[interval + 1], float(overshot.least.max()))
    needed = [
        replace(found, way=(finding.first, finding.last), seconds=finding.seconds, shortest=finding.shortest)
        for finding in infeasibilities(axis, segment, names, limits)
        if finding.seconds is not None and finding.shortest is not None
    ]
    return needed or [found]
