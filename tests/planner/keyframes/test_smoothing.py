"""The smoothest positions within a band, and bands that leave no way."""

from __future__ import annotations

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.keyframes.smoothing import smoothest

LIMITS = Limits(-100, 100, 30, 60, 300)
STEP = 1 / 24


def test_noise_within_the_band_is_gone() -> None:
    line = 5 * np.arange(100) * STEP
    noisy = line + np.random.default_rng(1).uniform(-0.09, 0.09, 100)
    found = smoothest(noisy - 0.1, noisy + 0.1, STEP, LIMITS, (False, False))
    assert found is not None
    assert np.abs(found - noisy).max() <= 0.1
    assert np.abs(np.diff(found, 3)).max() < 0.01 * np.abs(np.diff(noisy, 3)).max()


def test_free_samples_before_are_a_run_up_from_rest() -> None:
    line = 5 * np.arange(60) * STEP
    low, high = (np.concatenate([np.full(20, edge), line + side]) for edge, side in ((-100, -0.05), (100, 0.05)))
    found = smoothest(low, high, STEP, LIMITS, (True, False))
    assert found is not None
    assert abs(found[1] - found[0]) < 0.01
    assert found[0] < found[10] < found[20] < found[30]


def test_a_step_that_no_limit_allows_has_no_way() -> None:
    step = np.where(np.arange(40) < 20, 0.0, 5.0)
    assert smoothest(step - 0.1, step + 0.1, STEP, LIMITS, (False, False)) is None
    assert smoothest(step - 0.1, step + 0.1, STEP, None, (False, False)) is not None
