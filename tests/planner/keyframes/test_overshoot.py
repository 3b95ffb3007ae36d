"""Overshoot: no more than the limits force, against a linear programme that shares nothing with the planner."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Infeasible, Overshooting
from teleop.planner.keyframes.overshoot import LEAST, SHARE, least_overshoot, tolerated
from teleop.planner.keyframes.planner import Key, plan, stretch
from teleop.planner.keyframes.segment import Segment
from tests.support.move_lp import least_overshoot_lp

PAN, FOCUS = Axis.PAN, Axis.FOCUS
SIM = Limits(-180, 180, 120, 240, 1200)
SWING = [(0, 0), (5, -20), (6, 60), (16, 58)]
TIGHT = [(0, 0), (5, 4), (10, 84), (15, 88), (15.1, 88.6), (15.2, 88.5), (20, 80)]

Keys = Sequence[tuple[float, float]]


def named(keys: Keys, overshoot: float | None = None) -> list[Key]:
    return [Key(at, position, where=f"key {i}", overshoot=overshoot) for i, (at, position) in enumerate(keys, 1)]


def excess(keys: Keys, overshoot: float | None = None) -> float:
    """By how much the plan leaves the range of two neighboring keys, sampled."""
    move = plan({PAN: named(keys, overshoot)}, {PAN: SIM})
    worst = 0.0
    for (begin, one), (end, other) in pairwise(keys):
        position = move.sample(np.linspace(begin, end, 800))[PAN][0]
        worst = max(worst, position.max() - max(one, other), min(one, other) - position.min())
    return float(worst)


def lengthened(keys: Keys, finding: Overshooting) -> Keys:
    assert finding.way is not None
    first = int(finding.way[0][4:]) - 1
    later = finding.shortest - finding.seconds
    return [(at + (later if i > first else 0.0), position) for i, (at, position) in enumerate(keys)]


def test_one_tight_place_does_not_make_the_whole_leg_swing() -> None:
    assert excess(SWING, overshoot=5) < 2.2
    assert excess(TIGHT) < 0.06


@pytest.mark.parametrize("allowed", [3, 20, 360])
def test_what_is_allowed_is_not_used_where_less_will_do(allowed: float) -> None:
    assert excess(SWING, allowed) < 2.2


def test_more_than_is_tolerated_is_an_error_with_the_time_that_avoids_it() -> None:
    with pytest.raises(Infeasible) as refusal:
        plan({PAN: named(SWING)}, {PAN: SIM})
    (finding,) = refusal.value.findings
    assert isinstance(finding, Overshooting)
    assert finding.way == ("key 2", "key 3")
    assert "overshoot" in str(finding)
    assert "from key 2 to key 3, not 1.000 s" in str(finding)
    assert excess(lengthened(SWING, finding)) <= LEAST * 1.01
    shorter = lengthened(SWING, finding)
    with pytest.raises(Infeasible):
        excess([(at - (0.05 * finding.shortest if i > 1 else 0), p) for i, (at, p) in enumerate(shorter)])


def test_the_overshoot_that_it_names_is_enough() -> None:
    with pytest.raises(Infeasible) as refusal:
        plan({PAN: named(SWING)}, {PAN: SIM})
    allowed = float(str(refusal.value).partition("`overshoot: ")[2].partition("`")[0])
    assert excess(SWING, allowed) <= allowed * 1.01


def test_a_stretched_move_has_none() -> None:
    move, factor = stretch({PAN: named(SWING)}, {PAN: SIM})
    assert 1 < factor < 1.4
    assert move.overshoots == ()


def test_what_is_tolerated_is_a_share_of_the_way_or_what_the_file_says() -> None:
    segment = Segment(np.array([0.0, 1, 2, 3]), np.array([0.0, 80, 85, 0.5]))
    assert tolerated(PAN, segment, [None, None, 3.0]).tolist() == pytest.approx([80 * SHARE, LEAST, 3.0])
    assert tolerated(FOCUS, segment, [None] * 3)[1] == pytest.approx(0.05)
    assert tolerated(FOCUS, Segment(np.array([0.0, 1]), np.array([0.0, 0.1])), [None]).tolist() == [0.002]
    assert tolerated(PAN, segment, [np.inf] * 3).tolist() == [np.inf] * 3
    assert tolerated(PAN, segment, [np.inf, None, np.inf]).tolist() == tolerated(PAN, segment, [None] * 3).tolist()


@st.composite
def whole_number_moves(draw: st.DrawFn) -> Keys:
    gaps = draw(st.lists(st.integers(1, 8), min_size=2, max_size=4))
    positions = draw(st.lists(st.integers(-60, 60), min_size=len(gaps) + 1, max_size=len(gaps) + 1))
    return list(zip(np.cumsum([0, *gaps]).astype(float).tolist(), map(float, positions), strict=True))


@settings(max_examples=12, deadline=None)
@example(SWING)
@example(TIGHT)
@example([(0, 0), (1, 60), (3, 60), (5, 0)])
@given(whole_number_moves())
def test_it_is_about_the_least_that_an_independent_programme_finds(keys: Keys) -> None:
    """Within 25 %, and a twentieth of a degree: pieces of a polynomial are not as free as 160 steps of jerk."""
    least = least_overshoot_lp(keys, SIM)
    times, positions = np.array(keys).T
    found = least_overshoot(Segment(times, positions, stray=np.ones(len(keys) - 1)), SIM)
    if least is None:
        assert found is None
        return
    if found is None:
        return  # the programme only samples its limits; the planner keeps them with room
    assert least - 0.05 <= found.max() <= 1.25 * least + 0.05
    assert excess(keys, overshoot=2 * found.max() + 0.01) <= 1.2 * found.max() + 0.02
