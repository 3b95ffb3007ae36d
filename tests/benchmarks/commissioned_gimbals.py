"""Commission simulated gimbals in every variant of the known unknowns, and in combinations; figures at the end.

    python tests/benchmarks/commissioned_gimbals.py [COMBINATIONS] [SEED]

Each must give the right profile. A gimbal that does not is printed with what is wrong.
"""

from __future__ import annotations

import random
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from commission_variants import ORDERS, Variant, check

ONE_BY_ONE = {
    "as documented": Variant(),
    "every sign otherwise": Variant((-1, 1, -1), (1, -1, -1), (-1, -1, 1)),
    "legacy replies, exchanged": Variant(replies="legacy", order="yaw-pitch-roll"),
    "bare replies": Variant(replies="bare"),
    "exchanged in every reply": Variant(order="all-yaw-pitch-roll", signs=(1, -1, 1), report_signs=(1, -1, 1)),
    "silent pushes": Variant(silent_pushes=True),
    "no answer to questions for angles": Variant(silent_angles=True),
    "positions refused": Variant(refuses=("position",), report_signs=(-1, 1, 1)),
    "only the joystick": Variant(refuses=("position",), ignores_speed=True, speed_signs=(1, 1, -1)),
    "follow modes refused": Variant(refuses=("mode",)),
    "no focus motor": Variant(focus_motor="absent"),
    "drift": Variant(drift=0.5, lag=0.12, dead_time=0.04),
    "a blocked axis": Variant(held="roll"),
    "mounted turned round": Variant(mount=180.0, boot=(10.0, 0.0, -5.0)),
    "an adapter that resets": Variant(reset=31.3),
    "a bus that is not terminated": Variant(bus_errors=0.05),
}


def combination(chance: random.Random) -> Variant:
    def signs() -> tuple[int, int, int]:
        return chance.choice((1, -1)), chance.choice((1, -1)), chance.choice((1, -1))

    some: Any = chance.choice
    refuses = some([(), (), ("position",), ("speed",), ("mode",)])
    return Variant(
        signs=signs(),
        speed_signs=signs(),
        report_signs=signs(),
        replies=some(["new", "bare", "legacy"]),
        order=some(ORDERS),
        refuses=refuses,
        ignores_speed=some([True, False]),
        silent_pushes=some([True, False]),
        focus_motor=some(["calibrated", "uncalibrated", "absent"]),
        drift=0.0 if "position" in refuses else some([0.0, 0.0, 0.3, -0.6]),  # else nothing brings an axis back
        lag=some([0.02, 0.05, 0.12]),
        dead_time=some([0.0, 0.04, 0.09]),
        mount=some([0.0, 180.0]),
        held=some(["", "", "pan", "roll", "tilt"]),
        bus_errors=some([0.0, 0.0, 0.02]),
        reset=some([0.0, 0.0, 17.0, 60.0]),
    )


def main(combinations: int = 20, seed: int = 1) -> int:
    chance, wrong, began = random.Random(seed), 0, time.monotonic()
    variants = {**ONE_BY_ONE, **{f"combination {number}": combination(chance) for number in range(combinations)}}
    for name, variant in variants.items():
        with tempfile.TemporaryDirectory() as folder:
            bench = variant.bench(Path(folder))
            try:
                bench.run()
                check(variant, bench)
            except AssertionError as error:
                wrong += 1
                print(f"{name}: {variant}\n  {str(error)[:300]}\n  {bench.operator.troubles}", flush=True)
    print(f"{len(variants)} gimbals, {wrong} wrong, {time.monotonic() - began:.0f} s")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
