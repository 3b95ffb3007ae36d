"""Random descriptors, reports and plug events: no exception, no motion without a deflection after a center.

The same for as long as wanted: `python tests/benchmarks/fuzz_inputs.py 1000000`.
"""

from __future__ import annotations

from input_fuzz import fuzz


def test_random_devices_raise_nothing_and_move_nothing_before_they_were_centered() -> None:
    assert fuzz(8_000, seed=14).starts > 10, "some of them move something, so that this can fail"
