"""What a refusal or a warning says: axis, keys, what is needed, and what would help."""

from __future__ import annotations

import pytest

from teleop.core.axes import Axis
from teleop.planner.keyframes.findings import Finding, Infeasible, LongRamp, Overshoot, RampsTooLong, Unsolved

KEYS = Axis.PAN, "key 1", "key 2"


@pytest.mark.parametrize(
    ("factor", "seconds", "shortest", "text"),
    [
        (21.09, 0.5, 1.502, "needs 1.502 s from key 1 to key 2, not 0.500 s (jerk would be 21 x its limit)"),
        (1.04, 2.0, 2.1, "needs 2.100 s from key 1 to key 2, not 2.000 s (jerk would be 1.04 x its limit)"),
        (1.001, 2.0, 2.1, "needs 2.100 s from key 1 to key 2, not 2.000 s"),
    ],
)
def test_the_time_that_is_needed_comes_first(factor: float, seconds: float, shortest: float, text: str) -> None:
    assert str(Finding(*KEYS, "jerk", factor, seconds, shortest)) == f"pan {text}; or `fit: stretch`"


def test_where_no_time_was_searched_for_there_is_what_is_known() -> None:
    text = str(Finding(*KEYS, "velocity", 3.0, 2.0))
    assert text == "pan cannot go from key 1 to key 2 in 2.000 s (velocity would be 3 x its limit); or `fit: stretch`"
    text = str(Finding(*KEYS, "velocity", 3.0, 2.0, least=6.0))
    needs = "pan needs more than 6.000 s from key 1 to key 2, not 2.000 s"
    assert text == f"{needs} (velocity would be 3 x its limit); or `fit: stretch`"


@pytest.mark.parametrize(
    ("axis", "limit", "text"),
    [
        (Axis.PAN, "minimum", "pan is 1.5 deg below its minimum at key 1"),
        (Axis.FOCUS, "maximum", "focus is 1.5 above its maximum at key 1"),
    ],
)
def test_a_key_beyond_a_soft_limit_has_its_distance_and_its_unit(axis: Axis, limit: str, text: str) -> None:
    assert str(Finding(axis, "key 1", "key 1", limit, 1.5)) == text


def test_the_other_findings_name_their_keys_too() -> None:
    ramps = str(RampsTooLong(*KEYS, 3, 2, 4, 5))
    assert ramps == "pan needs 5.000 s for its ramps (3 s + 2 s) from key 1 to key 2, not 4.000 s; or a shorter `ease`"
    ramps = str(RampsTooLong(*KEYS, 3, 2, 4))
    assert ramps == "pan has no time for its ramps (3 s + 2 s) from key 1 to key 2 in 4.000 s; use a shorter `ease`"
    assert str(Unsolved(*KEYS)) == "pan: no plan found from key 1 to key 2; use a longer `ease`, or more time"
    assert str(Overshoot(*KEYS, 0.8261)) == "pan overshoots by 0.826 deg between key 1 and key 2, to keep its limits"
    assert str(LongRamp(Axis.PAN, "key 1", 0.05, 0.523)) == "pan needs a ramp of 0.52 s at key 1, not 0.05 s"


def test_a_refusal_has_all_its_findings() -> None:
    found = [Unsolved(*KEYS), Finding(Axis.TILT, "key 3", "key 3", "minimum", 1.0)]
    error = Infeasible(found)
    assert error.findings == tuple(found)
    assert str(error) == f"{found[0]}; {found[1]}"
