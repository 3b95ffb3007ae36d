"""Random files that a rig refuses take their suggestions: `tests/benchmarks/hunt_refusals.py --files 60 --seed 1`.

Each file has keys of up to three axes, some of them with holds, stops and ramps. Its suggestions are read from the
lines that a user sees and taken one after the other, moving all later keys. Then it must be playable at once, and not
with 5 % less of any one time. Prints what is not so, and the longest refusal as a multiple of the plan that follows.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from time import process_time

import numpy as np

from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.planner import plan

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
from refused_moves import LIMITS, Keys, asked_of, needs_of, random_file, taken


def refusal(keys: Keys) -> Infeasible | None:
    try:
        plan(keys, LIMITS)
    except Infeasible as error:
        return error
    return None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--files", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    refused = wrong = long = 0
    slowest = 0.0
    while refused < arguments.files:
        keys = random_file(rng)
        begin = process_time()
        error = refusal(keys)
        spent = process_time() - begin
        if error is None:
            continue
        refused += 1
        needs = needs_of(error)
        begin = process_time()
        again = refusal(taken(keys, needs))
        slowest = max(slowest, spent)
        if again is not None:
            wrong += 1
            sys.stdout.write(f"file {refused} is refused again: {again}\n  after {error}\n")
            continue
        for way, seconds in needs.items():
            less = max(0.95 * seconds, asked_of(error)[way])
            others = max((s for w, s in needs.items() if w[1:] == way[1:] and w != way), default=0.0)
            if others < less and refusal(taken(keys, needs | {way: less})) is None:
                long += 1
                sys.stdout.write(f"file {refused}: {way} would do with 5 % less than {seconds}\n  {error}\n")
    sys.stdout.write(f"{refused} refused: {wrong} refused again, {long} times too long, slowest {slowest:.2f} s\n")


if __name__ == "__main__":
    main()
