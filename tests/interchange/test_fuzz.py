"""A thousand hostile files of each format: refused in one line, or read; `benchmarks/fuzz_interchange.py` has more."""

from __future__ import annotations

from pathlib import Path

import pytest
from interchange_fuzz import READERS, attack


@pytest.mark.parametrize("name", READERS)
def test_whatever_a_file_is_nothing_else_is_raised(name: str, tmp_path: Path) -> None:
    attack(name, 1000, 20261129, tmp_path, binary=False)
