"""Fuzz of the console, 1e5 of HTTP and of WebSocket: `python tests/benchmarks/console_fuzz.py [COUNT]`.

In the same process, without sockets; it ends with an AssertionError or with how many answers of each kind there were.
"""

from __future__ import annotations

import asyncio
import sys
import tempfile
import time
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from console_fuzz import fuzz_http, fuzz_websocket

COUNT = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000

for name, fuzz in (("HTTP", fuzz_http), ("WebSocket", fuzz_websocket)):
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "moves"
        folder.mkdir()
        began = time.monotonic()
        found = asyncio.run(fuzz(Random(1), folder, COUNT))
        outside = [each for each in Path(place).rglob("*") if each != folder and folder not in each.parents]
        assert not outside, outside
        print(f"{name}: {COUNT} in {time.monotonic() - began:.0f} s: {dict(sorted(found.items(), key=str))}")
