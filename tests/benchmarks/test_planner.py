"""Issue 4's figures: `pytest tests/benchmarks/test_planner.py --benchmark-enable -s -n 0` prints them as ratios.

The unit is one bare Ruckig velocity update of 4 axes with a new target, measured in the same run, so that the machine
drops out. Nothing is asserted about time: the figures are for reading, and for comparing over commits.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from itertools import cycle
from time import perf_counter
from typing import Any

import numpy as np
import pytest
from ruckig import ControlInterface, InputParameter, OutputParameter, Ruckig, Synchronization

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import Demand, StateTarget, VelocityTarget
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live

AXES = (Axis.PAN, Axis.TILT, Axis.ROLL, Axis.FOCUS)
LIMITS = {
    Axis.PAN: Limits(-170, 170, 60, 120, 600),
    Axis.TILT: Limits(-56, 146, 60, 120, 600),
    Axis.ROLL: Limits(-30, 30, 30, 90, 450),
    Axis.FOCUS: Limits(0, 1, 0.8, 3, 20),
}
DT = 0.01

Scene = tuple[Callable[[Any], object], Iterator[Any]]  # what is called, and with what each time


def bare_update() -> Scene:
    """The unit: set a target, update, pass on."""
    ruckig, question, answer = Ruckig(4, DT), InputParameter(4), OutputParameter(4)
    question.control_interface, question.synchronization = ControlInterface.Velocity, Synchronization.No
    question.max_velocity, question.max_acceleration, question.max_jerk = [60.0] * 4, [120.0] * 4, [600.0] * 4
    rng = random.Random(1)
    targets = cycle([[rng.uniform(-60, 60) for _ in range(4)] for _ in range(1009)])

    def update(target: list[float]) -> None:
        question.target_velocity = target
        ruckig.update(question, answer)
        answer.pass_to_input(question)

    return update, targets


def live_away() -> Scene:
    """Noisy sticks about 0 in the middle of continuous axes: no soft limit is ever near."""
    live = Live({a: Limits(-math.inf, math.inf, *_magnitudes(a)) for a in AXES}, DT)
    live.reset({axis: State(0.5) for axis in AXES})
    return live.step, cycle(_noisy_sticks(lambda rng, v: rng.uniform(-v, v)))


def live_near() -> Scene:
    """Noisy sticks that swing every axis from one soft limit onto the other and hold it there for a while."""
    live = Live({a: Limits(0, LIMITS[a].velocity / 2, *_magnitudes(a)) for a in AXES}, DT)
    live.reset({axis: State(LIMITS[axis].velocity / 4) for axis in AXES})
    rng = random.Random(2)
    demands: list[Demand] = []
    for sign in (1, -1) * 6:
        demands += [
            {a: VelocityTarget(sign * rng.uniform(0.4, 0.5) * LIMITS[a].velocity) for a in AXES} for _ in range(150)
        ]
    return live.step, cycle(demands)


def tracking() -> Scene:
    """A compiled move of all axes, up and down again."""
    keys = {a: [Key(0, 0.0), Key(4, _reach(a)), Key(6, _reach(a) / 2), Key(10, 0.0)] for a in AXES}
    move = plan(keys, LIMITS)
    live = Live(LIMITS, DT)
    live.reset(move.start)
    demands: list[Demand] = [
        {axis: StateTarget(*state) for axis, state in move.at(tick * DT).items()} for tick in range(1, 1001)
    ]
    return live.step, cycle(demands)


def _magnitudes(axis: Axis) -> tuple[float, float, float]:
    limits = LIMITS[axis]
    return limits.velocity, limits.acceleration, limits.jerk


def _reach(axis: Axis) -> float:
    return 0.8 * LIMITS[axis].maximum


def _noisy_sticks(draw: Callable[[random.Random, float], float]) -> list[Demand]:
    rng = random.Random(3)
    return [{a: VelocityTarget(draw(rng, LIMITS[a].velocity)) for a in AXES} for _ in range(2003)]


def keys(count: int) -> dict[Axis, list[Key]]:
    """A wander of `count` keys on each axis, about as busy as an operator would make it."""
    rng = np.random.default_rng(count)
    at = np.cumsum(rng.uniform(1, 4, count))
    result = {}
    for axis in AXES:
        limits = LIMITS[axis]
        steps = rng.uniform(-0.35, 0.35, count) * limits.velocity
        position = np.clip(np.cumsum(steps), limits.minimum, limits.maximum)
        result[axis] = [Key(float(t), float(p)) for t, p in zip(at, position, strict=True)]
    return result


def ratio(scene: Scene, unit: Scene, batches: int = 200, size: int = 50) -> float:
    """The median over batches of `scene` / `unit`, taken in turns so that a busy machine slows both.

    Both are called here, in the same way: a lambda about the step alone would be a call that the unit does not pay.
    """
    ratios = []
    for _ in range(batches):
        spent = []
        for function, inputs in (unit, scene):
            times = [perf_counter()]
            for _ in range(size):
                function(next(inputs))
                times.append(perf_counter())
            spent.append(np.median(np.diff(times)))
        ratios.append(spent[1] / spent[0])
    return float(np.median(ratios))


def median_seconds(call: Callable[[], object], count: int) -> float:
    spent = []
    for _ in range(count):
        start = perf_counter()
        call()
        spent.append(perf_counter() - start)
    return float(np.median(spent))


@pytest.fixture(scope="module")
def unit() -> float:
    update, targets = bare_update()
    return median_seconds(lambda: update(next(targets)), 20_000)


@pytest.fixture
def report(request, capsys):
    """Print a figure, its ratio and what the issue allows; only when benchmarks are asked for."""
    if not request.config.getoption("benchmark_enable"):
        pytest.skip("figures are measured with --benchmark-enable")

    def write(name: str, ratio: float, allowed: float) -> None:
        with capsys.disabled():
            print(f"\n{name}: {ratio:,.2f} x (at most {allowed:,.0f} x)", end="")

    return write


@pytest.mark.parametrize(("scene", "allowed"), [(live_away, 4), (live_near, 12), (tracking, 6)])
def test_one_step_of_four_axes(scene, allowed, report):
    report(f"one step, {scene.__name__}", ratio(scene(), bare_update()), allowed)


@pytest.mark.parametrize(("count", "allowed"), [(10, 25_000), (200, 250_000), (2000, 2_500_000)])
def test_planning_four_axes(count, allowed, unit, report):
    wanted = keys(count)
    report(f"plan {count} keys", median_seconds(lambda: plan(wanted, LIMITS), 1 if count > 200 else 5) / unit, allowed)


def test_chunked_evaluation(report):
    """Against numpy evaluating one quintic and its three derivatives over as many samples."""
    move = plan({Axis.PAN: keys(200)[Axis.PAN]}, LIMITS)
    rate = 1_000_000 / move.duration
    coefficients = np.random.default_rng(0).normal(size=6)
    order = [
        np.polynomial.Polynomial(coefficients).deriv(k) if k else np.polynomial.Polynomial(coefficients)
        for k in range(4)
    ]

    def bare() -> None:
        for first in range(0, 1_000_000, 1 << 15):
            times = np.arange(first, first + (1 << 15)) / 1e6
            np.stack([polynomial(times) for polynomial in order])

    def chunked() -> None:
        for _ in move.chunks(rate):
            pass

    report("chunked evaluation / bare polynomial", median_seconds(chunked, 5) / median_seconds(bare, 5), 3)
