"""Fuzz what reads input devices: `python tests/benchmarks/fuzz_inputs.py 1000000`, with a seed behind it if wanted.

Each part has a seed of its own, which is printed with what it found, so that one that fails can be played alone.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from input_fuzz import Tally, fuzz

PART = 10_000  # events
SEEDS = 1_000  # of the parts of one run

if __name__ == "__main__":
    events, seed = (int(word) for word in (sys.argv[1:] + ["1000000", "1"][len(sys.argv) - 1 :])[:2])
    total = Tally()
    while total.events < events:
        part = seed * SEEDS + total.events // PART
        print(f"seed {part}: ", end="", flush=True)
        total.add(fuzz(min(PART, events - total.events), part))
        print(f"in all {total}; none without a hand, no exception", flush=True)
