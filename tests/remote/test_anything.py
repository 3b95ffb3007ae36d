"""Any commands of those who have no control: each is answered, nothing raises and nothing moves."""

from __future__ import annotations

from pathlib import Path

from door_fuzz import fuzzed


def test_whatever_comes_by_the_door_raises_nothing_and_moves_nothing(tmp_path: Path) -> None:
    assert fuzzed(tmp_path, 800) > 0
