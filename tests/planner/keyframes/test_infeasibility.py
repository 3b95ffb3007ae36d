"""Refusals are true: what they say would do does, and less does not."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Finding, Infeasible
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.keyframes.ramp import Ramp
from teleop.planner.keyframes.repeat import Repeat, repeated

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}


def refusal(keys) -> Sequence[Finding]:
    try:
        plan(keys, LIMITS)
    except Infeasible as error:
        return [finding for finding in error.findings if isinstance(finding, Finding)]
    return ()


def named(times, positions):
    return [Key(t, p, where=f"key {i + 1}") for i, (t, p) in enumerate(zip(times, positions, strict=True))]


def lengthened(keys, durations):
    """The keys with each segment named by its last key's `where` lasting so long, later keys shifted."""
    shift, result = 0.0, [keys[0]]
    for first, last in pairwise(keys):
        shift += durations.get(last.where, last.at - first.at) - (last.at - first.at)
        result.append(replace(last, at=last.at + shift))
    return result


@settings(max_examples=12)
@example([(0.0625, 0.0), (0.25, 84.0)])  # a short way beside a long one
@example([(0.504, -22.6), (0.239, 17.2), (1.202, -48.4)])
@example([(0.492, -4.9), (0.629, -148.8), (1.185, 29.4)])  # the second key next to a soft limit
@given(st.lists(st.tuples(st.floats(0.05, 2.5), st.floats(-165, 165)), min_size=1, max_size=5))
def test_the_shortest_times_would_do_and_five_percent_less_would_not(segments):
    times, positions = [0.0], [0.0]
    for seconds, position in segments:
        times.append(times[-1] + seconds)
        positions.append(position)
    keys = named(times, positions)
    findings = refusal({PAN: keys})
    assume(findings)
    durations = {f.last: f.shortest for f in findings if f.shortest is not None and f.seconds is not None}
    assert len(durations) == len(findings)
    assert refusal({PAN: lengthened(keys, durations)}) == ()
    for finding in findings:
        shorter = max(finding.seconds or 0.0, 0.95 * durations[finding.last])
        assert refusal({PAN: lengthened(keys, durations | {finding.last: shorter})}) != ()
        assert durations[finding.last] > (finding.seconds or 0.0)
        assert finding.factor > 1


def test_all_findings_of_all_axes_at_once():
    keys = {PAN: named([0, 4, 4.5, 9], [0, 40, 80, 80]), TILT: named([0, 0.5, 1.0], [0, 30, 0])}
    found = {(f.axis, f.first) for f in refusal(keys)}
    assert {axis for axis, _ in found} == {PAN, TILT}
    assert (PAN, "key 2") in found


def test_too_far_in_the_time_is_the_velocity():
    (finding,) = refusal({PAN: named([0, 2], [0, 150])})
    assert (finding.limit, finding.first, finding.last) == ("velocity", "key 1", "key 2")
    assert finding.factor > 150 / 2 / (0.95 * 60)  # the mean velocity, and it starts and ends at rest


def test_a_short_step_is_the_jerk():
    # rest to rest, jerk-limited: 32 d / T^3
    (finding,) = refusal({PAN: named([0, 0.2], [0, 0.5])})
    assert finding.limit == "jerk"
    assert finding.shortest == pytest.approx((32 * 0.5 / 570) ** (1 / 3), rel=0.05)


def test_only_the_segment_in_the_way_is_blamed():
    found = refusal({PAN: named([0, 0.854, 3], [0, 40, 50])})
    assert [f.last for f in found] == ["key 2"]


def test_the_text_says_it_all():
    finding = Finding(PAN, "key 3", "key 4", "jerk", 2.031, 0.854, 1.022)
    assert str(finding) == (
        "pan needs 1.022 s from key 3 to key 4, not 0.854 s (jerk would be 2.03 x its limit); or `fit: stretch`"
    )
    beyond = Finding(TILT, "key 2", "key 2", "maximum", 1.5)
    assert str(beyond) == "tilt is 1.5 deg above its maximum at key 2"
    assert "\n" not in str(Infeasible([finding, beyond]))


@settings(max_examples=10)
@given(
    st.lists(st.tuples(st.floats(0.1, 1.5), st.floats(-100, 100)), min_size=1, max_size=3),
    st.integers(2, 5),
)
def test_what_is_gone_several_times_is_one_finding_whose_time_does_for_all(
    segments: list[tuple[float, float]], times: int
) -> None:
    def bounced(durations: Sequence[float]) -> dict[Axis, list[Key]]:
        ends = np.cumsum([0.0, *durations])
        keys = [Key(at, p, where=f"key {i}") for i, (at, p) in enumerate(zip(ends, positions, strict=True))]
        return repeated({PAN: keys}, times, Repeat.BOUNCE)

    positions = [0.0, *(position for _, position in segments)]
    durations = [seconds for seconds, _ in segments]
    findings = refusal(bounced(durations))
    assume(findings)
    pairs = [{finding.first, finding.last} for finding in findings]
    assert all(pairs.count(pair) == 1 for pair in pairs)
    for finding in findings:
        segment = min(int(finding.first[4:]), int(finding.last[4:]))
        assert finding.shortest is not None
        durations[segment] = finding.shortest
    assert refusal(bounced(durations)) == ()


def test_what_another_axis_takes_longer_for_anyhow_is_no_finding_of_a_ramp():
    """`hunt_refusals.py --seed 3`, file 19: tilt has time for its ramps as soon as pan has what it needs."""
    ease = Ramp(0.5)
    keys = {
        PAN: [Key(0, -17, leave=ease, where="key 1"), Key(0.6, 163, arrive=ease, where="key 3")],
        TILT: [
            Key(0, -27, leave=ease, where="key 1"),
            Key(0.3, -8, stop=True, arrive=ease, leave=ease, where="key 2"),
            Key(0.6, -27, arrive=ease, where="key 3"),
        ],
    }
    with pytest.raises(Infeasible) as error:
        plan(keys, LIMITS)
    assert [str(finding).partition(" (")[0] for finding in error.value.findings] == [
        "tilt needs 1.000 s for its ramps",
        "tilt needs 1.155 s from key 1 to key 2, not 0.300 s",
        "pan needs 3.878 s from key 1 to key 3, not 0.600 s",
    ]
