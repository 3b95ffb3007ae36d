"""The live planner's long fuzz: `python tests/benchmarks/fuzz_live.py --ticks 10000000 --seed 1`.

Random sticks with noise and gentler limits, presets, references, stops, limit changes, late ticks and start states
(outside the limits too), each for a random while. Prints the largest excess over p, v, a and j; exits 1 on the first
beyond 1e-6, with what led to it. `tests/planner/test_live.py` does the same for a shorter time with shrinking.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
from dataclasses import replace

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, Stop, VelocityTarget
from teleop.planner.live import Live

LIMITS = {
    Axis.PAN: Limits(-170, 170, 60, 120, 600),
    Axis.TILT: Limits(-30, 40, 40, 90, 480),
    Axis.ROLL: Limits(-math.inf, math.inf, 60, 120, 600),
    Axis.FOCUS: Limits(0, 1, 0.8, 3, 20),
}
DT = 0.01
TOLERANCE = 1e-6


def place(rng: random.Random, limits: Limits) -> float:
    """Anywhere on the axis, and a tenth beyond."""
    low, high = max(limits.minimum, -400.0), min(limits.maximum, 400.0)
    return rng.uniform(low - (high - low) / 10, high + (high - low) / 10)


def wish(rng: random.Random, limits: Limits) -> Setpoint | None:
    velocity = rng.choice([0.0, limits.velocity, -limits.velocity, rng.uniform(-1.2, 1.2) * limits.velocity])
    kind = rng.choices(["stick", "gentle stick", "preset", "reference", "halt", "none"], [3, 3, 3, 2, 1, 1])[0]
    if kind == "stick":
        return VelocityTarget(velocity)
    if kind == "gentle stick":
        return VelocityTarget(velocity, rng.uniform(0, 1.2) * limits.acceleration, rng.uniform(0, 1.2) * limits.jerk)
    if kind == "preset":
        return PositionTarget(place(rng, limits), rng.choice([None, rng.uniform(0, 8)]))
    if kind == "reference":
        return StateTarget(place(rng, limits), velocity, rng.uniform(-1, 1) * limits.acceleration)
    return Stop() if kind == "halt" else None


def narrowed(rng: random.Random, limits: Limits) -> Limits:
    inset = 0.0 if limits.continuous else rng.uniform(0, 0.4) * (limits.maximum - limits.minimum)
    return replace(
        limits,
        minimum=limits.minimum + inset,
        maximum=limits.maximum - inset,
        velocity=limits.velocity * rng.uniform(0.3, 1),
    )


def noisy(rng: random.Random, wanted: Setpoint) -> Setpoint:
    """What a stick with 3 % noise, or a reference that moves on, asks for a tick later."""
    if isinstance(wanted, VelocityTarget):
        return wanted._replace(velocity=wanted.velocity * (1 + rng.gauss(0, 0.03)))
    if isinstance(wanted, StateTarget):
        return wanted._replace(position=wanted.position + wanted.velocity * DT)
    return wanted


def excess(before: State, after: State, limits: Limits, seconds: float) -> dict[str, float]:
    """By how much a step leaves each limit, jerk and the velocity within the step by finite differences."""
    return {
        "p": max(
            after.position - max(limits.maximum, before.position), min(limits.minimum, before.position) - after.position
        ),
        "v": max(abs(after.velocity), abs(after.position - before.position) / seconds) - limits.velocity,
        "a": max(abs(after.acceleration), abs(after.velocity - before.velocity) / seconds) - limits.acceleration,
        "j": abs(after.acceleration - before.acceleration) / seconds - limits.jerk,
    }


def run(seed: int, ticks: int) -> dict[str, float]:
    rng = random.Random(seed)
    worst = dict.fromkeys("pvaj", -math.inf)
    live = Live(LIMITS, DT)
    live.reset({axis: State(place(rng, limits)) for axis, limits in LIMITS.items()})
    done = 0
    while done < ticks:
        demand = {axis: w for axis, limits in LIMITS.items() if (w := wish(rng, limits)) is not None}
        shaky = rng.random() < 0.4
        if rng.random() < 0.02:
            live.reset({axis: State(place(rng, limits)) for axis, limits in LIMITS.items()})
        if rng.random() < 0.02:  # narrower and slower: never outside the old limits on the way into the new ones
            live.limit({axis: narrowed(rng, limits) for axis, limits in LIMITS.items()})
        elif rng.random() < 0.04:
            live.limit(LIMITS)
        for _ in range(rng.choice([1, 2, 5, 50, 300, 600])):
            if shaky:
                demand = {axis: noisy(rng, w) for axis, w in demand.items()}
            dt_steps = rng.choice([1] * 12 + [2, 3, 7])
            before, after = live.motion, live.step(demand, dt_steps)
            done += 1
            for axis, limits in LIMITS.items():
                for name, value in excess(before[axis], after[axis], limits, dt_steps * DT).items():
                    worst[name] = max(worst[name], value)
                    if value > TOLERANCE:
                        sys.exit(
                            f"seed {seed}, tick {done}: {axis} {name} by {value:.3g}, {demand.get(axis)} x {dt_steps}"
                            f"\n  {before[axis]}\n  {after[axis]}"
                        )
    return worst


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=int, default=10_000_000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    worst = run(arguments.seed, arguments.ticks)
    sys.stdout.write(
        f"{arguments.ticks} ticks, largest excess: " + ", ".join(f"{k} {v:.2g}" for k, v in worst.items()) + "\n"
    )


if __name__ == "__main__":
    main()
