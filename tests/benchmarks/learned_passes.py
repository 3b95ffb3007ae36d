"""Passes that learn, on gimbals that were not measured: `learned_passes.py [COUNT [SEED [KNOWN]]]`.

KNOWN is the share of each gimbal's delay that its profile has. Without it the profile has none: it is identified.

Prints for each gimbal the RMS of three passes, and at the end how many did not come down to a quarter of the first pass
or under 0.05 degrees by the third. The exit code is 1 when one did not.
"""

from __future__ import annotations

import math
import random
import sys
import tempfile
from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "support"))
from learning_bench import FAST, SLOW, learned, rig

TILTED = {"keyframes": [{"at": 0, "pan": 0, "tilt": 0}, {"at": 3, "pan": 40, "tilt": 20}, {"at": 5, "pan": 30}]}
SHARE, ENOUGH = 0.25, 0.05  # of the first pass's RMS; deg


def corners() -> Iterator[Mapping[str, float]]:
    for lag, dead, (gain, drift) in product((0.03, 0.1, 0.2), (0.0, 0.05, 0.1), ((1, 0), (0.85, 1), (1.1, -1))):
        yield {"lag": lag, "dead_time": dead, "gain": gain, "drift": drift, "backlash": 0.05}


def random_gimbals(count: int, seed: int) -> Iterator[Mapping[str, float]]:
    draw = random.Random(seed)
    for _ in range(count):
        yield {
            "lag": round(draw.uniform(0.03, 0.2), 3),
            "dead_time": round(draw.uniform(0, 0.1), 3),
            "gain": round(draw.uniform(0.85, 1.1), 3),
            "drift": round(draw.uniform(-1, 1), 2),
            "backlash": 0.05,
        }


def main() -> int:
    count, seed, known = (float(each) for each in [*sys.argv[1:], *("0", "1", "nan")[len(sys.argv) - 1 :]])
    bad = total = 0
    gimbals = random_gimbals(int(count), int(seed)) if count else corners()
    for gimbal, (name, move) in product(list(gimbals), {"fast": FAST, "slow": SLOW, "tilted": TILTED}.items()):
        with tempfile.TemporaryDirectory() as folder:
            delay = None if math.isnan(known) else known * (gimbal["lag"] + gimbal["dead_time"])
            found = learned(rig(gimbal, delay=delay), move, 3, Path(folder))
        for axis in found.plan.axes:
            rms = found.rms(axis.value) if len(found.learner.passes) == 3 else [1.0, 1.0, 1.0]
            good = min(rms[1:]) <= max(SHARE * rms[0], ENOUGH)
            total, bad = total + 1, bad + (not good)
            told = "" if good else f"  NOT ENOUGH {found.report.run.reasons}"
            print(f"{gimbal} {name} {axis}: {' '.join(f'{each:.3f}' for each in rms)}{told}", flush=True)
    print(f"{bad} of {total} were not good enough")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
