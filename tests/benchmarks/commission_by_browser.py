"""Every step of a commissioning by a client gives the profile of the terminal; 1e5 commands of strangers press no key.

Run it by itself: `python tests/benchmarks/commission_by_browser.py [AMOUNT]`. CI runs a share of it:
tests/remote/test_commission_hands.py.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from commission_bench import CommissionBench
from commission_door import commission_door, fuzzed
from commission_variants import Variant

VARIANTS = (
    Variant(),
    Variant((-1, 1, -1), (1, -1, 1)),
    Variant(refuses=("position",), report_signs=(-1, 1, 1), lag=0.12),
)


def same(variant: Variant) -> bool:
    with TemporaryDirectory() as terminal, TemporaryDirectory() as browser:
        variant.bench(Path(terminal)).run()
        with commission_door(variant.bench(Path(browser))) as door:
            door.operated()
        texts = [(Path(each) / "out.yaml").read_text() for each in (terminal, browser)]
        return texts[0] == texts[1]


def main() -> None:
    amount = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    for variant in VARIANTS:
        print("the same profile" if same(variant) else "ANOTHER PROFILE", variant)
    with TemporaryDirectory() as folder, commission_door(CommissionBench(Path(folder) / "out.yaml")) as door:
        door.to_the_first_move()
        print(f"{fuzzed(door, amount)} of {amount} were no commands; none pressed a key")


if __name__ == "__main__":
    main()
