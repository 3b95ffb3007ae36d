"""Random realistic moves: `python tests/benchmarks/random_moves.py --moves 300 --seed 1 [--hurried]`.

Realistic is what the planning page's figure shows: keys 1.3 to 6 s apart, at up to 20 deg/s in the mean. `--hurried`
ones have 0.9 to 4 times the time that each segment needs from rest to rest, where limits have most to say. Prints how
many are planned, how many of those that are feasible by an independent check are, how many overshoot, and the jerk RMS
as a share of J (0.035, docs/explanation/planning.md, "B. Keyframes"). The independent
check is Ruckig: a move is feasible when every interval can be driven from rest to rest in its time within 0.95 of the
limits. That is sufficient, not necessary, so moves that it does not call feasible may well be planned too.
"""

from __future__ import annotations

import argparse
import sys
from itertools import pairwise

import numpy as np
from ruckig import InputParameter, Ruckig, Trajectory

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.planner import Key, plan

LIMITS = Limits(-170, 170, 60, 120, 600)
HEADROOM = 0.95


def rest_to_rest(distance: float) -> float:
    """Ruckig's shortest time in seconds."""
    question, answer = InputParameter(1), Trajectory(1)
    question.target_position = [distance]
    question.max_velocity = [HEADROOM * LIMITS.velocity]
    question.max_acceleration = [HEADROOM * LIMITS.acceleration]
    question.max_jerk = [HEADROOM * LIMITS.jerk]
    Ruckig(1).calculate(question, answer)
    return answer.duration


def random_keys(rng: np.random.Generator, hurried: bool) -> list[Key]:
    """2..14 keys, a sixth of them stops."""
    count = rng.integers(1, 14)
    if hurried:
        positions = np.clip(np.cumsum(rng.normal(0, 30, count + 1)), -160, 160)
        needed = np.array([rest_to_rest(abs(step)) for step in np.diff(positions)])
        gaps = np.maximum(needed * rng.uniform(0.9, 4, count), 0.3)
    else:
        gaps = rng.uniform(1.3, 6, count)
        positions = np.clip(np.cumsum(np.append(0.0, rng.uniform(-20, 20, count) * gaps)), -160, 160)
    times = np.append(0.0, np.cumsum(gaps))
    return [
        Key(float(at), float(position), stop=bool(rng.random() < 0.15), where=f"key {i + 1}")
        for i, (at, position) in enumerate(zip(times, positions, strict=True))
    ]


def feasible(keys: list[Key]) -> bool:
    return all(
        last.at - first.at >= rest_to_rest(abs(last.position - first.position)) for first, last in pairwise(keys)
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moves", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hurried", action="store_true")
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    possible = planned = both = overshooting = 0
    jerks: list[float] = []
    for _ in range(arguments.moves):
        keys = random_keys(rng, arguments.hurried)
        sure = feasible(keys)
        possible += sure
        try:
            move = plan({Axis.PAN: keys}, {Axis.PAN: LIMITS})
        except Infeasible as refusal:
            sys.stdout.write(f"refused{' though feasible' if sure else ''}: {refusal}\n")
            continue
        planned += 1
        both += sure
        overshooting += bool(move.overshoots)
        jerk = move.sample(np.linspace(0, move.duration, 5000))[Axis.PAN][3]
        jerks.append(float(np.sqrt(np.mean(jerk**2))) / LIMITS.jerk)
    sys.stdout.write(
        f"planned {planned} of {arguments.moves}; of {possible} surely feasible ones {both}"
        f" ({100 * both / possible:.1f} %); {overshooting} overshoot; jerk RMS median {np.median(jerks):.3f} J\n"
    )


if __name__ == "__main__":
    main()
