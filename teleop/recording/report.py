"""How well a run went, axis by axis: how far from commanded, how much later, how much of the limits.

Every reading is compared with what was commanded at its own time, as in the report after a run. A delay is reported
only where the run allows it: a few degrees at changing speeds, measured often enough, on an axis that follows its
commands. The shares of the limits are those of the ticks, which is what the gimbal was sent.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.core.timing import PERIOD
from teleop.monitors.delay_estimate import EARLIEST, LATEST, estimate
from teleop.planner.polynomial import Array
from teleop.recording.reader import Take

LEAST_WAY = {"deg": 2.0, "": 0.05}  # by unit: less is a matter of the grid of the readings
SURE = 0.01  # s of doubt at most
FAITHFUL = 0.5, 1.5  # times as far as commanded
MOST_READINGS = 5000  # of those in motion: a few minutes tell as much as hours
AROUND = 0.6  # s before and after a motion that belong to it
EDGE = 0.005  # s: a shift that near to the last that is tried is none


@dataclass(frozen=True)
class AxisReport:
    """Errors are planned less measured (units), NaN without readings; `peak_at` is in s from the first tick.

    `delay` is None where it is unknown, and then `untold` is the reason. `velocity`, `acceleration` and `jerk` are the
    greatest shares of the limits, `room` the least to a soft limit, None for a continuous axis.
    """

    readings: int
    rms: float
    peak: float
    peak_at: float
    delay: float | None
    untold: str
    velocity: float
    acceleration: float
    jerk: float
    room: float | None


def report(take: Take) -> Mapping[Axis, AxisReport]:
    """Every axis of a take; none for one that is empty."""
    return {axis: _axis(take, axis, take.about.limits[axis]) for axis in take.axes if len(take.times)}


def errors(take: Take, axis: Axis) -> tuple[Array, Array]:
    """When (s) the axis was measured during the run, and planned less measured there (units)."""
    read_at, read = take.measured.get(axis, np.empty((2, 0)))
    during = (read_at >= take.times[0]) & (read_at <= take.times[-1])
    return read_at[during], np.interp(read_at[during], take.times, take.planned(axis)) - read[during]


def _axis(take: Take, axis: Axis, limits: Limits) -> AxisReport:
    position, velocity, acceleration = take.motion[axis]
    steps = np.diff(take.times)
    whole = (steps > 0) & (steps < 1.5 * PERIOD)
    jerk = np.abs(np.diff(acceleration)[whole] / steps[whole]).max(initial=0.0)
    room = min(float(position.min()) - limits.minimum, limits.maximum - float(position.max()))
    read_at, error = errors(take, axis)
    worst = int(np.abs(error).argmax()) if len(error) else 0
    delay, untold = _delay(take, axis)
    return AxisReport(
        len(error),
        float(np.sqrt(np.mean(error**2))) if len(error) else math.nan,
        float(abs(error[worst])) if len(error) else math.nan,
        float(read_at[worst]) if len(error) else math.nan,
        delay,
        untold,
        float(np.abs(velocity).max() / limits.velocity),
        float(np.abs(acceleration).max() / limits.acceleration),
        float(jerk / limits.jerk),
        None if limits.continuous else room,
    )


def _delay(take: Take, axis: Axis) -> tuple[float | None, str]:
    """How much later than commanded the axis moved (s), or why that is unknown."""
    read_at, read = take.measured.get(axis, np.empty((2, 0)))
    if not len(read_at):
        return None, "it was not measured"
    moving = np.abs(take.motion[axis][1]) > 0
    if not moving.any():
        return None, "it did not move"
    moved_at = take.times[moving]
    nearest = np.clip(np.searchsorted(moved_at, read_at), 1, max(len(moved_at) - 1, 1))
    before, after = moved_at[nearest - 1], moved_at[np.minimum(nearest, len(moved_at) - 1)]
    during = np.minimum(np.abs(read_at - before), np.abs(read_at - after)) <= AROUND
    read_at, read = read_at[during][:MOST_READINGS], read[during][:MOST_READINGS]
    if not len(read) or np.ptp(read) < LEAST_WAY[axis.unit]:
        return None, "it hardly moved"
    commanded = np.array([take.times, take.motion[axis][0]]).T
    found = estimate(commanded.tolist(), np.array([read_at, read]).T.tolist(), float(read_at[0]), float(read_at[-1]))
    if found is None:
        return None, "it was measured too rarely"
    if not found.doubt <= SURE:
        return None, "its speed changed too little, or it did not follow its commands"
    if not FAITHFUL[0] <= found.scale <= FAITHFUL[1]:
        return None, f"it moved {found.scale:.2f} times as far as commanded"
    if not EARLIEST + EDGE < found.seconds < LATEST - EDGE:
        return None, f"it lies outside {EARLIEST:g} .. {LATEST:g} s"
    return found.seconds, ""
