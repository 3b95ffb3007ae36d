from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from remote_bench import RemoteBench, remote_bench


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[RemoteBench]:
    """Nobody has control yet."""
    with remote_bench(tmp_path) as made:
        yield made


@pytest.fixture
def held(bench: RemoteBench) -> RemoteBench:
    """Anna has control."""
    assert "ok" in bench.ask("take_control")
    return bench
