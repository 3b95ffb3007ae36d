"""Whether an interval can hold what a frame takes: prefocus, exposure, post-exposure, the move to the next, settling.

Asked of every frame with the limits of the rig, because one long step in an hour of short ones is what ruins a night.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Mapping
from typing import NamedTuple, Protocol

import numpy as np

from teleop.config.quantities import seconds
from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.go_motion import RAMP, ExposureRuns
from teleop.planner.polynomial import Array, extremes
from teleop.planner.rest_to_rest import shortest
from teleop.planner.time_scaling import at_most
from teleop.planner.trajectory import Move
from teleop.sequence.timelapse_section import SettleSection, TimelapseSection
from teleop.timelapse.schedule import Schedule

STEP_SHARE = 0.95  # of velocity, acceleration and jerk for a step between two frames that has no time to lose
TICKS = 0.02  # s: a step begins and ends on the loop's grid
TIGHT = 0.1  # of an interval; with less to spare than this a warning is due


class Phases(NamedTuple):
    """What one frame takes besides its move, in s. `below` is the rate (deg/s) at which it has settled before `settle`
    is over, None where only time tells."""

    prefocus: float
    exposure: float
    post: float
    settle: float
    below: float | None

    @classmethod
    def of(cls, section: TimelapseSection, fps: float | None) -> Phases:
        prefocus, exposure, post = (seconds(value, fps) for value in (section.prefocus, section.exposure, section.post))
        if isinstance(section.settle, Mapping):
            settle = SettleSection.model_validate(section.settle)
            return cls(prefocus, exposure, post, seconds(settle.at_most, fps), settle.below)
        return cls(prefocus, exposure, post, seconds(section.settle, fps), None)

    def text(self, **more: float) -> str:
        """Those that take any time: `exposure 0.5 s + settle 0.3 s`."""
        return _sum({"prefocus": self.prefocus, "exposure": self.exposure, "post": self.post, **more})


def _sum(parts: Mapping[str, float]) -> str:
    return " + ".join(f"{name} {value:.3g} s" for name, value in parts.items() if value > 0) or "nothing"


class FramePath(Protocol):
    def positions(self, count: int) -> Mapping[Axis, Array]: ...

    def on(self, slots: Schedule) -> Move: ...


def budget(
    phases: Phases,
    slots: Schedule,
    path: FramePath,
    limits: Mapping[Axis, Limits],
    continuous: bool,
    runs: Mapping[Axis, ExposureRuns] | None = None,
) -> tuple[list[str], list[str]]:
    """What the interval cannot hold, and what it can hardly hold; both are to stand after `interval`.

    `runs` are those through the exposures, None where the axes rest.
    """
    if slots.frames < 2:
        return [], []
    if 2 * min(slots.first, slots.last) <= abs(slots.change):
        return [f"changes by {abs(slots.change):.3g} s per frame, too much for its shortest interval"], []
    fixed = phases.prefocus + phases.exposure + phases.post
    if continuous:
        problems, warnings = _held(np.full(slots.frames - 1, fixed), slots, lambda _frame: phases.text())
        fast, nearly = _speed(path.on(slots), slots, limits)
        return problems + fast, warnings + nearly
    if runs is not None:
        return _with_runs(phases, slots, limits, runs)
    moves = _moves(path.positions(slots.frames), limits)
    needs = fixed + phases.settle + moves
    return _held(needs, slots, lambda frame: phases.text(move=moves[frame], settle=phases.settle))


def _with_runs(
    phases: Phases, slots: Schedule, limits: Mapping[Axis, Limits], runs: Mapping[Axis, ExposureRuns]
) -> tuple[list[str], list[str]]:
    """The axes move before, in and after the exposure, and then to where the next run begins."""
    before, after = max(RAMP, phases.prefocus), max(RAMP, phases.post)
    ways = {axis: np.abs(of.starts[1:] - of.ends[:-1]) for axis, of in runs.items()}
    moves = _times(ways, limits)
    needs = before + phases.exposure + after + phases.settle + moves

    def text(frame: int) -> str:
        parts = {"run-up": before, "exposure": phases.exposure, "run-out": after, "move": moves[frame]}
        return _sum({**parts, "settle": phases.settle})

    return _held(needs, slots, text)


def _moves(positions: Mapping[Axis, Array], limits: Mapping[Axis, Limits]) -> Array:
    """Seconds for each step between two frames (count - 1,)."""
    return _times({axis: np.abs(np.diff(of_axis)) for axis, of_axis in positions.items()}, limits)


def _times(ways: Mapping[Axis, Array], limits: Mapping[Axis, Limits]) -> Array:
    """Seconds for each way, whole ticks and what they round; the axes go together."""
    longest = np.max([shortest(way, limits[axis].scaled(STEP_SHARE)) for axis, way in ways.items()], axis=0)
    return np.where(longest > 0, longest + TICKS, 0.0)


def _held(needs: Array, slots: Schedule, text: Callable[[int], str]) -> tuple[list[str], list[str]]:
    """Of the interval after each frame (count - 1,) and what it `needs`."""
    intervals = np.array([slots.interval(frame) for frame in range(slots.frames - 1)])
    spare = intervals - needs
    worst = int(spare.argmin())
    takes = f"frame {worst} of {slots.frames} takes {text(worst)}"
    if spare[worst] < -SAME_TIME:
        return [_too_short(intervals, needs, worst, takes, slots)], []
    if spare[worst] < TIGHT * intervals[worst]:
        return [], [f"is tight: {takes}, which leaves {spare[worst]:.2f} s of {intervals[worst]:.3g} s"]
    return [], []


def _too_short(intervals: Array, needs: Array, worst: int, takes: str, slots: Schedule) -> str:
    least = math.ceil(needs[worst] * 100 - SAME_TIME) / 100
    if not slots.change:
        return f"must be at least {least:.2f} s, not {intervals[worst]:g} s: {takes}"
    many = int(np.count_nonzero(intervals < needs - SAME_TIME))
    others = f" ({many} frames are too short)" if many > 1 else ""
    return f"is {intervals[worst]:.2f} s and must be at least {least:.2f} s: {takes}{others}"


def _speed(move: Move, slots: Schedule, limits: Mapping[Axis, Limits]) -> tuple[list[str], list[str]]:
    """Of a move that goes on while frames are shot."""
    rate = at_most(move, limits)
    if rate >= 1 / (1 - TIGHT):
        return [], []
    time, axis, limit = _fastest(move, limits)
    frame = _frame_at(time, slots)
    if rate >= 1:
        return [], [f"is tight: at frame {frame} {axis} is near its {limit} limit"]
    least = math.ceil(slots.interval(frame) / rate * 100 - SAME_TIME) / 100
    return [
        f"must be at least {least:.2f} s, not {slots.interval(frame):.3g} s: frame {frame}: {axis} needs "
        f"{1 / rate:.2f} x its {limit} limit"
    ], []


def _fastest(move: Move, limits: Mapping[Axis, Limits]) -> tuple[float, Axis, str]:
    """Where a move asks most of its limits: the time in s, the axis and the limit."""
    found: list[tuple[float, float, Axis, str]] = []
    for axis, track in move.tracks.items():
        if not len(track.coefficients):
            continue
        least, greatest = extremes(track.coefficients, np.diff(track.breaks))
        for order, name in enumerate(("velocity", "acceleration", "jerk"), 1):
            share = (np.maximum(-least[order], greatest[order]) / getattr(limits[axis], name)) ** (1 / order)
            piece = int(share.argmax())
            found.append((float(share[piece]), float(track.breaks[piece]), axis, name))
    _, time, axis, name = max(found)
    return time, axis, name


def _frame_at(time: float, slots: Schedule) -> int:
    """The last frame that is due by `time`."""
    return max(0, bisect_right(range(slots.frames), time + SAME_TIME, key=slots.at) - 1)
