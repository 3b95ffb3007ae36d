"""Whatever is sent raises nothing, moves nothing without the right token, and touches no file outside the folder.

The same with 1e5 of each: tests/benchmarks/console_fuzz.py.
"""

from __future__ import annotations

import asyncio
from random import Random

from console_fuzz import fuzz_http, fuzz_websocket


def test_http_takes_whatever_comes(tmp_path):
    folder = tmp_path / "moves"
    folder.mkdir()
    found = asyncio.run(fuzz_http(Random(7), folder, 2000))
    assert {200, 400, 401, 403, 404, 405, 413} <= set(found)
    assert list(tmp_path.iterdir()) == [folder]


def test_a_websocket_takes_whatever_comes(tmp_path):
    found = asyncio.run(fuzz_websocket(Random(7), tmp_path, 1000))
    assert found["invalid"] > 100
    assert found["forbidden"] > 10
