"""Whether every frame of a go-motion timelapse can be moved through, and what would do where one cannot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.go_motion import ExposureRuns

LONGEST = 3600.0  # s: an exposure that is not suggested
_HALVINGS = 20
MANY = 300  # frames that what would do is found for


def blur_problem(runs: Mapping[Axis, ExposureRuns]) -> str:
    """To stand after `blur`: the frame and the axis that ask most of a limit; empty where all keep theirs."""
    shares = {(axis, name): share for axis, of in runs.items() for name, share in of.shares().items()}
    axis, name = max(shares, key=lambda each: shares[each].max())
    worst = shares[axis, name]
    if worst.max() <= 1:
        return ""
    frame = int(worst.argmax())
    if name == "soft":
        what = f"leaves its soft limits by {worst[frame] - 1:.2g}{axis.unit and ' ' + axis.unit} on its run through it"
    else:
        what = f"needs {worst[frame]:.2f} x its {name} limit to move through the exposure"
    return f"is too much: frame {frame} of {len(worst)}: {axis} {what}; {_cure(runs)}"


def _cure(runs: Mapping[Axis, ExposureRuns]) -> str:
    """What would do for every frame of every axis."""
    exposures = [_least_exposure(_worst(of)) for of in runs.values()]
    blurs = [_most_blur(_worst(of)) for of in runs.values()]
    ways = []
    if max(exposures) <= LONGEST:
        ways.append(f"an exposure of at least {math.ceil(max(exposures) * 100 - 1e-6) / 100:g} s")
    if min(blurs) >= 0.001:
        ways.append(f"a blur of at most {math.floor(min(blurs) * 1000) / 1000:g}")
    return f"{' or '.join(ways)} would do" if ways else "keep the keyframes away from the soft limits"


def _worst(runs: ExposureRuns) -> ExposureRuns:
    """Those that ask most of a limit: to ask all of a long shoot again and again would take minutes."""
    shares = np.max(list(runs.shares().values()), axis=0)
    return runs.only(np.argsort(shares)[-MANY:].tolist())


def _keeps(runs: ExposureRuns) -> bool:
    return all(share.max() <= 1 for share in runs.shares().values())


def _least_exposure(runs: ExposureRuns) -> float:
    """In s; inf where none would do."""
    if _keeps(runs):
        return runs.exposure
    low, high = runs.exposure, 2 * runs.exposure
    while not _keeps(replace(runs, exposure=high)):
        low, high = high, 2 * high
        if high > 2 * LONGEST:
            return math.inf
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if _keeps(replace(runs, exposure=middle)) else (middle, high)
    return high


def _most_blur(runs: ExposureRuns) -> float:
    """0 where none would do."""
    if _keeps(runs):
        return runs.blur
    low, high = 0.0, runs.blur
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if _keeps(replace(runs, blur=middle)) else (low, middle)
    return low
