"""Fuzz what reads input devices: `python tests/benchmarks/fuzz_inputs.py 1000000`, with a seed behind it if wanted."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from input_fuzz import fuzz

if __name__ == "__main__":
    events, seed = (int(word) for word in (sys.argv[1:] + ["1000000", "1"][len(sys.argv) - 1 :])[:2])
    print(f"seed {seed}: {fuzz(events, seed)}; none without a hand, no exception")
