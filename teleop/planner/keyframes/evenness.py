"""How even a segment's speed is to be: what a deviation costs, how finely to cut where it changes, where it may stop.

With a `tension` of its own, deviation is weighed by a time: changes of speed then take about TAU / tension. Without
one, keys that are passed through in one direction are met at an even speed: there a change takes a share of the
interval, whatever it lasts. A way between two keys, and one that turns at each of them, is as smooth as can be.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.tension import EVEN, Tension
from teleop.planner.polynomial import Array, derivative, evaluate

TAU = 0.25  # s: tension 1 weighs velocity as 1/TAU^4
RATES = np.array([8.0, 3.0, 1.2])  # T / tau of an interval that begins or ends at a rest or a turn: neither, one, both
SLOWER = 100.0  # most that a slow interval counts beside a fast one; ten times that where it would be almost at rest
STILL = 0.02  # of an interval's mean speed: slower is almost at rest
URGE = 3.0  # T / tau of an interval that would be almost at rest, T its shorter neighbor's
LONG = 0.15  # of an interval: a smooth start takes 3 % of it at such a speed
STEADY = 5.0  # acceleration between ramps weighs T / STEADY, jerk its ramp cubed: the speed is even within 2 %
SAMPLES = 16  # per piece


def turning(segment: Segment) -> NDArray[np.bool_]:
    """Per key whether the motion rests there or changes its direction."""
    direction = np.sign(segment.steps)
    rests = np.any(segment.ends != 0, axis=1)
    return np.concatenate([[not rests[0]], direction[:-1] != direction[1:], [not rests[1]]])


def velocity_weights(segment: Segment, tension: Tension) -> Array:
    """Per interval the weight of its squared velocity beside that of its squared jerk, in 1/s^4."""
    if tension != EVEN:
        weights = np.full(len(segment.steps), (tension / TAU) ** 4)
    elif segment.ramps is not None or len(segment.steps) == 1:
        weights = np.zeros(len(segment.steps))
    else:
        turns = turning(segment)
        weights = _relative(segment, RATES[turns[:-1].astype(int) + turns[1:]] / segment.durations, SLOWER)
    return weights if segment.urged is None else weights + segment.urged


def _relative(segment: Segment, rates: Array, most: float) -> Array:
    """Weights by which changes of speed take about 1 / rate (n,) s, and a slow interval counts as a fast one.

    Beside jerk, or beside acceleration where there are ramps.
    """
    speed = np.abs(segment.steps) / segment.durations
    typical = np.sqrt(np.average(speed**2, weights=segment.durations))
    slower = np.clip(typical / np.maximum(speed, typical / most), 0.0, most) if typical else 1.0
    if segment.ramps is None:
        return rates**4 * slower**2
    return float(segment.times[-1] - segment.times[0]) / STEADY * rates**2 * slower**2


def urged(segment: Segment, still: Array) -> Segment:
    """With more weight on the speed of the intervals in which it is almost at rest for so many seconds (n,).

    As much as the shorter of its neighbors has, or that one's would count alone.
    """
    durations = np.pad(segment.durations, 1, constant_values=np.inf)
    shortest = np.minimum(np.minimum(durations[:-2], durations[2:]), segment.durations)
    return replace(segment, urged=np.where(still > 0, _relative(segment, URGE / shortest, 10 * SLOWER), 0.0))


def change_times(segment: Segment, tension: Tension) -> Array:
    """Per end of each interval (n, 2) the seconds of a piece that can show how its speed changes there; inf for all."""
    weights = velocity_weights(segment, tension)
    turns = turning(segment)
    at = np.stack([turns[:-1], turns[1:]], axis=1)
    with np.errstate(divide="ignore"):
        return np.where(at, (weights**-0.25)[:, None], np.inf)


def stills(segment: Segment, widths: Array, coefficients: Array) -> Array:
    """Per interval (n,) the seconds in which it is almost at rest, 0 where they are no longer than a start takes."""
    local = widths[:, None] * (np.arange(SAMPLES) + 0.5) / SAMPLES
    speed = np.abs(evaluate(derivative(coefficients), local))
    middles = segment.times[0] + np.cumsum(widths) - widths / 2
    interval = np.searchsorted(segment.times, middles) - 1
    slow = (speed < STILL * (np.abs(segment.steps) / segment.durations)[interval, None]).mean(axis=1) * widths
    seconds = np.bincount(interval, slow, minlength=len(segment.steps))
    return np.where(seconds > LONG * segment.durations, seconds, 0.0)
