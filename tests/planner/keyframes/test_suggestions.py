"""A refusal costs about as much as a plan, and a file that takes its suggestions is playable at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from refused_moves import CASES, LIMITS, Refused, needs_of, random_file, taken

from teleop.planner.keyframes import least_times, qp
from teleop.planner.keyframes.findings import Finding, Infeasible, Unsolved
from teleop.planner.keyframes.planner import plan


def refusal(keys) -> Infeasible | None:
    try:
        plan(keys, LIMITS)
    except Infeasible as error:
        return error
    return None


@settings(max_examples=4)
@given(st.integers(0, 2**32))
def test_a_file_that_takes_all_suggestions_is_playable(seed: int) -> None:
    """Of all axes together, at once; tests/benchmarks/hunt_refusals.py tries hundreds."""
    keys = random_file(np.random.default_rng(seed))
    error = refusal(keys)
    if error is not None:
        assert refusal(taken(keys, needs_of(error))) is None


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[], object]], float]:
    """What the solver does in a call, whatever the load of the machine: entries of its matrices, and its calls."""
    solved = [0.0]
    minimize = qp.minimize

    def counting(*problem, **quickly):
        solved[0] += problem[2].nnz + 2000  # a call costs as much as so many entries
        return minimize(*problem, **quickly)

    monkeypatch.setattr(qp, "minimize", counting)
    monkeypatch.setattr(least_times, "minimize", counting)

    def of(call: Callable[[], object]) -> float:
        solved[0] = 0.0
        call()
        return solved[0]

    return of


SMALLER: dict[str, Callable[[], Refused]] = {
    "track": lambda: CASES["track"](30),
    "noise": lambda: CASES["noise"](100),
    "panorama": lambda: CASES["panorama"](1.0, 40.0),
    "stops": lambda: CASES["stops"](40),
    "bounce": lambda: CASES["bounce"](99),
    "wander": lambda: CASES["wander"](120),
}


@pytest.mark.parametrize("name", SMALLER)
def test_a_refusal_costs_at_most_three_plans_of_its_size(name: str, work) -> None:
    case = SMALLER[name]()
    planned = work(lambda: plan(case.partner, LIMITS))
    assert work(lambda: refusal(case.keys)) <= 3 * planned


@pytest.mark.parametrize("slower", [1.15, 1.3, 1.5])
def test_a_long_leg_that_is_almost_possible_is_refused_as_soon_and_with_a_place(slower: float, work) -> None:
    case = CASES["wander"](200)
    keys = {axis: [key.later(slower) for key in of_axis] for axis, of_axis in case.keys.items()}
    planned = work(lambda: plan(case.partner, LIMITS))
    assert work(lambda: refusal(keys)) <= 3.5 * planned
    error = refusal(keys)
    assert error is not None
    assert not any(isinstance(finding, Unsolved) for finding in error.findings)


def test_a_bounce_that_takes_its_suggestions_is_playable() -> None:
    for times in (5, 99):
        error = refusal(CASES["bounce"](times).keys)
        assert error
        longer = {each.last: each.shortest for each in error.findings if isinstance(each, Finding)}
        assert {"key 2", "key 3"} >= set(longer)
        assert len(error.findings) <= 4
