"""The planner with random keys: `python tests/benchmarks/hunt_plan.py --cases 100000 --seed 1`.

Each case is one axis with random limits, tension and 2 to 6 keys: whole numbers and tiny steps, equal keys, keys on
soft limits, twitches beside long ways, stops, holds and ramps of any length. What must hold of each answer: there is a
plan or a reason (a limit that gives, a ramp that is too long, an overshoot), never neither; a plan meets its keys
and the limits, ends with its last key and overshoots no more than tolerated. Reasons are asked for in a share of the
refusals (`--reasons`), as they cost more than plans. Prints every case that breaks this; exits with 1 if there was one.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Infeasible, PlanError, Unsolved
from teleop.planner.keyframes.overshoot import LEAST, SHARE
from teleop.planner.keyframes.planner import Key, attempt, plan
from teleop.planner.keyframes.ramp import Ramp
from teleop.planner.keyframes.tension import Tension
from teleop.planner.trajectory import Move

PAN = Axis.PAN
MET = 1e-3  # units


def random_limits(rng: random.Random) -> Limits:
    velocity = rng.choice([5, 30, 60, 120])
    return Limits(-180, 180, velocity, velocity * rng.choice([1, 2, 4]), velocity * rng.choice([5, 10, 20]))


def random_ramp(rng: random.Random) -> Ramp | None:
    return rng.choice([None, None, Ramp(0.0), Ramp(0.5), Ramp(rng.uniform(0, 5)), Ramp(share=rng.uniform(0, 0.5))])


def random_keys(rng: random.Random) -> list[Key]:
    """Times and positions each from several pools, so that unlike ones meet."""
    keys: list[Key] = []
    at, position = 0.0, float(rng.choice([0, 180, -180, 70, rng.randint(-90, 90)]))
    eased = rng.random() < 0.4
    for number in range(rng.randint(2, 6)):
        ramps = (random_ramp(rng), random_ramp(rng)) if eased else (None, None)
        stop, hold = rng.random() < 0.15, rng.choice([0.0] * 8 + [0.5, 2.0])
        keys.append(Key(at, position, stop, hold, f"key {number + 1}", *ramps))
        at += hold + rng.choice([1, 1, 2, 5, 10, 0.05, 0.2, 60, 3600, rng.uniform(0.1, 8), rng.randint(1, 12)])
        step = rng.choice([0, 0.002, -0.5, rng.randint(-40, 40), rng.randint(-90, 90), rng.uniform(-20, 20)])
        position = min(max(position + step, -180.0), 180.0)
    return keys


def faults(keys: Sequence[Key], limits: Limits, move: Move) -> list[str]:
    """What a plan does not keep."""
    if PAN not in move.tracks:
        return ["the axis is left out"]
    peaks = move.peaks()[PAN]
    found = [
        f"{name} {peak:g} of {limit:g}"
        for name, peak, limit in (
            ("velocity", peaks.velocity, limits.velocity),
            ("acceleration", peaks.acceleration, limits.acceleration),
            ("jerk", peaks.jerk, limits.jerk),
            ("maximum", peaks.maximum, limits.maximum + MET),
            ("minimum", -peaks.minimum, MET - limits.minimum),
        )
        if peak > limit
    ]
    found += [f"{key.where} is missed" for key in keys if abs(move.at(key.at)[PAN].position - key.position) > MET]
    if abs(move.duration - keys[-1].at - keys[-1].hold) > MET:
        found.append(f"lasts {move.duration:g} s")
    steps = {first.where: abs(last.position - first.position) for first, last in pairwise(keys)}
    for overshoot in move.overshoots:
        if overshoot.size > 1.01 * max(LEAST, SHARE * steps[overshoot.first]):
            found.append(str(overshoot))
    return found


def reasons(keys: Sequence[Key], limits: Limits, tension: Tension) -> list[str]:
    """What is wrong with a refusal."""
    try:
        plan({PAN: keys}, {PAN: limits}, tension)
    except Infeasible as refusal:
        if not refusal.findings:
            return ["refused without a reason"]
        return [str(finding) for finding in refusal.findings if isinstance(finding, Unsolved)]
    return ["refused once and planned once"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--reasons", type=float, default=0.05)
    arguments = parser.parse_args()
    counts: Counter[str] = Counter()
    for case in range(arguments.cases):
        rng = random.Random(arguments.seed * 1_000_003 + case)
        limits, keys = random_limits(rng), random_keys(rng)
        tension: Tension = rng.choice(["even", "even", 0.0, 0.5, 1.0])
        wrong: list[str] = []
        try:
            move = attempt({PAN: keys}, {PAN: limits}, tension)
            if move is not None:
                counts["overshoots" if move.overshoots else "standstills" if move.standstills else "planned"] += 1
                wrong = faults(keys, limits, move)
            else:
                counts["refused"] += 1
                wrong = reasons(keys, limits, tension) if rng.random() < arguments.reasons else []
        except PlanError as error:
            counts["no plan at all"] += 1
            wrong = [] if "is not after" in str(error) else [str(error)]
        except Exception as error:  # noqa: BLE001  whatever it is, it is what is hunted for
            wrong = [repr(error)]
        if wrong:
            counts["wrong"] += 1
            sys.stdout.write(f"case {case}: {'; '.join(wrong)}\n  {limits} tension {tension} {keys}\n")
            sys.stdout.flush()
    sys.stdout.write(f"{dict(counts)}\n")
    return int(counts["wrong"] > 0)


if __name__ == "__main__":
    raise SystemExit(main())
