"""The curve of least jerk without limits is the planner's own where no limit is near."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.core.axes import Limits
from teleop.planner.keyframes.minimum_jerk import minimum_jerk
from teleop.planner.keyframes.program import Rule
from teleop.planner.keyframes.qp import solve
from teleop.planner.keyframes.segment import Segment
from teleop.planner.trajectory import Track

WIDE = Limits(-1e5, 1e5, 1e6, 1e6, 1e7)


@pytest.mark.parametrize("count", [2, 3, 4, 9])
def test_it_is_what_the_planner_finds(count: int) -> None:
    random = np.random.default_rng(count)
    times = np.concatenate([[0.0], np.cumsum(random.uniform(0.5, 2, count - 1))])
    positions = random.normal(0, 10, count)
    solved = solve(Segment(times, positions), WIDE, Rule(2, False))
    assert solved is not None
    widths, coefficients = solved
    planned = Track(np.concatenate([[0.0], np.cumsum(widths)]), coefficients, positions[-1])
    at = np.linspace(0, times[-1], 200)
    assert minimum_jerk(times, positions).sample(at)[0] == pytest.approx(planned.sample(at)[0], abs=1e-6)
