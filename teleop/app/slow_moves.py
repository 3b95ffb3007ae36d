"""Moves that are slower than a gimbal can show: its position commands are whole tenths of a degree.

Between two steps such a gimbal stands still, and a long lens shows it. Speed commands have no such steps of position.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import floor

import numpy as np

from teleop.app.planning import Plan
from teleop.config.frame_rates import shown_rate
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.planner.median import median
from teleop.planner.polynomial import Array

STEP = 0.1  # deg: the resolution of a gimbal's position commands (docs/protocol-facts.md)
ACTION = 0.1  # s in which a gimbal carries out such a command: slower than a step in that time, it stands between them
SLOWEST = STEP / ACTION  # deg/s
SHOWN_AT = 24.0  # frames a second, where the file does not say it
MOST = 100_000  # frames that are looked at
STILL = 1e-6  # deg: less from frame to frame is no motion


def slow_moves(plan: Plan) -> Iterator[str]:
    """A line for each axis of a gimbal in position mode that moves less than a step in most frames."""
    for sink in plan.profile.sinks:
        if not isinstance(sink, GimbalSection) or sink.mode != "position":
            continue
        for axis in (Axis.PAN, Axis.TILT, Axis.ROLL):
            if axis in plan.sequence.move.tracks and axis in sink.axes:
                yield from _slow(plan, axis)


def _slow(plan: Plan, axis: Axis) -> Iterator[str]:
    positions, fps = _by_frame(plan, axis)
    moved = np.abs(np.diff(positions))
    moving = moved > STILL
    if not moving.any():
        return
    steps = np.abs(np.diff(np.round(positions / STEP))).astype(int)[moving]
    typical = median(moved[moving])
    if typical >= (STEP if fps is None else SLOWEST / fps):
        return
    way, frames, still = float(np.ptp(positions)), int(moving.sum()), int((steps == 0).sum())
    what = f"{axis} moves {way:.3g} deg in {frames + 1} frames"
    if fps is not None:
        what += f" at {shown_rate(fps)} fps"
    most = int(steps.max(initial=0)) * STEP
    shown = f"in position mode that is {still} frames without a step, and {frames - still} of {most:.1f} deg"
    mend = f"use at most {max(2, floor(frames * typical / STEP))} frames"
    if fps is not None:
        fewer = max(2, floor(frames * typical * fps / SLOWEST))
        mend = f"use `mode: speed` in the profile, or at most {fewer} frames"
    yield f"{what}: {shown}; {mend} (a longer lens only shows it more)"


def _by_frame(plan: Plan, axis: Axis) -> tuple[Array, float | None]:
    """Positions at the frames, and how many of those are shown a second; None for a timelapse."""
    if plan.timelapse is not None:
        return plan.timelapse.path.positions(min(plan.timelapse.frames, MOST))[axis], None
    rate = plan.sequence.fps or SHOWN_AT
    count = min(MOST, floor(plan.sequence.move.duration * rate + STILL) + 1)
    return plan.sequence.move.tracks[axis].sample(np.arange(count) / rate)[0], rate
