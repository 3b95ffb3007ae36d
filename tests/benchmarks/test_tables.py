"""A table of 240 frames and 3 axes is fitted in a few times what planning its keys once takes."""

from __future__ import annotations

from time import process_time

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.frame_keys import Frames
from teleop.planner.keyframes.frames import FrameFitter
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.planner import plan

LIMITS = Limits(-180, 180, 120, 240, 1200)
MOST = 25  # plans: measured 4 to 6


def test_a_fit_costs_a_few_plans() -> None:
    times, noise = np.arange(240) / 24, np.random.default_rng(1)
    waves = {Axis.PAN: (20, 0.8), Axis.TILT: (10, 0.5), Axis.ROLL: (3, 1.3)}
    tables = [
        Frames(axis, size * np.sin(rate * times + 0.3) + noise.normal(0, 0.02, 240), 0.1, LIMITS)
        for axis, (size, rate) in waves.items()
    ]
    begin = process_time()
    found = FrameFitter(tables, 24).fit()
    fitted = process_time() - begin
    keys = {
        axis: [Key((place + found.runs.up) / 24, position, tension=0.0) for place, position in of_axis.items()]
        for axis, of_axis in found.keys.items()
    }
    begin = process_time()
    plan(keys, dict.fromkeys(keys, LIMITS))
    planned = process_time() - begin
    print(f"\n240 frames x 3 axes: {fitted / planned:.1f} plans of their {sum(map(len, keys.values()))} keys")
    assert fitted < MOST * planned
