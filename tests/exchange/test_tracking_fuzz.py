"""A share of tests/benchmarks/tracking.py: what no tracker sends raises nothing, and moves nothing."""

from __future__ import annotations

import pytest
from tracking_fuzz import fuzzed


@pytest.mark.parametrize("tracks", [False, True])
def test_hostile_datagrams_raise_nothing_and_move_nothing_beyond_a_limit(tmp_path, tracks):
    assert fuzzed(tmp_path, 1000, seed=2, tracks=tracks) > 0
