"""Ease at the ends of a way: up to speed in the time asked for, even speed, and down again, within the limits."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.planner import Key, plan, stretch
from teleop.planner.keyframes.ramp import NAMES, Ramp
from teleop.planner.keyframes.repeat import Repeat, repeated

PAN = Axis.PAN
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600)}


def speeds(move, *times):
    return np.abs(move.sample(np.array(times, float))[PAN][1])


@pytest.mark.parametrize(
    ("duration", "leave", "arrive"),
    [(10, 1, 1), (10, 1, 4), (10, 3, 0.5), (600, 5, 5), (3600, 60, 5), (86400, 600, 60)],
)
def test_the_speed_is_even_between_the_ramps_and_changes_within_them(duration, leave, arrive):
    keys = [Key(0, -40, leave=Ramp(leave)), Key(duration, 60, arrive=Ramp(arrive))]
    move = plan({PAN: keys}, LIMITS)
    cruise = 100 / (duration - (leave + arrive) / 2)
    between = speeds(move, *np.linspace(leave, duration - arrive, 500))
    assert between == pytest.approx(cruise, rel=0.05)
    up, down = speeds(move, *np.linspace(0, leave, 200)), speeds(move, *np.linspace(duration - arrive, duration, 200))
    assert (np.diff(up) >= -0.03 * cruise).all()
    assert (np.diff(down) <= 0.03 * cruise).all()
    assert up[100] == pytest.approx(cruise / 2, rel=0.1)
    assert not move.long_ramps


def test_a_share_and_seconds_are_the_same_ease():
    by_share = plan({PAN: [Key(2, 0, leave=Ramp(share=0.2)), Key(12, 50)]}, LIMITS)
    by_seconds = plan({PAN: [Key(2, 0), Key(12, 50, arrive=Ramp(2.0))]}, LIMITS)
    times = np.linspace(0, 14, 300)
    np.testing.assert_allclose(by_share.sample(times)[PAN], by_seconds.sample(times)[PAN], atol=1e-9)


def test_a_softer_name_takes_longer_to_get_up_to_speed():
    halfway = [speeds(plan({PAN: [Key(0, 0, leave=ramp), Key(10, 50)]}, LIMITS), 1.0)[0] for ramp in NAMES.values()]
    assert halfway == sorted(halfway, reverse=True)
    assert halfway[0] > 2 * halfway[-1]


def test_a_ramp_shorter_than_the_limits_allow_is_as_short_as_they_do_and_said():
    move = plan({PAN: [Key(0, 0, leave=Ramp(0.05), where="key 1"), Key(4, 120, where="key 2")]}, LIMITS)
    assert [(ramp.last, ramp.asked) for ramp in move.long_ramps] == [("key 1", 0.05), ("key 2", 0.05)]
    taken = move.long_ramps[0].taken
    assert str(move.long_ramps[0]) == f"pan needs a ramp of {taken:.2f} s at key 1, not 0.05 s"
    assert speeds(move, taken)[0] == pytest.approx(120 / (4 - taken), rel=0.05)
    assert speeds(move, taken / 2)[0] < 0.7 * speeds(move, taken)[0]


def test_no_ramp_at_all_asks_for_the_shortest_there_is_without_a_word():
    move = plan({PAN: [Key(0, 0, leave=Ramp(0.0)), Key(10, 80)]}, LIMITS)
    assert not move.long_ramps
    assert speeds(move, 0.5)[0] == pytest.approx(8, rel=0.05)


def test_ramps_that_do_not_fit_are_refused_all_at_once():
    keys = [
        Key(0, 0, leave=Ramp(3.0), where="key 1"),
        Key(4, 10, stop=True, arrive=Ramp(2.0), leave=Ramp(5.0), where="key 2"),
        Key(8, 0, where="key 3"),
    ]
    with pytest.raises(Infeasible) as refusal:
        plan({PAN: keys}, LIMITS)
    assert [str(finding) for finding in refusal.value.findings] == [
        "pan needs 5.000 s for its ramps (3 s + 2 s) from key 1 to key 2, not 4.000 s; or a shorter `ease`",
        "pan needs 10.000 s for its ramps (5 s + 5 s) from key 2 to key 3, not 4.000 s; or a shorter `ease`",
    ]
    with pytest.raises(Infeasible):
        stretch({PAN: keys}, LIMITS)


def test_a_dwell_and_a_standing_axis_have_nothing_to_ease():
    ramp = Ramp(2.0)
    keys = [Key(0, 5, leave=ramp), Key(1, 5, hold=0.5, arrive=ramp, leave=ramp), Key(7, 20, arrive=ramp)]
    move = plan({PAN: keys}, LIMITS)
    assert move.at(1.4)[PAN].position == 5
    assert speeds(move, 0.5, 1.5)[0] == 0


def test_a_bounce_eases_at_the_same_places_on_the_way_back():
    there = [Key(0, 0, leave=Ramp(2.0), stop=True), Key(10, 50, stop=True, arrive=Ramp(0.5))]
    move = plan(repeated({PAN: there}, 2, Repeat.BOUNCE), LIMITS)
    times = np.linspace(0, 10, 200)
    np.testing.assert_allclose(speeds(move, *times), speeds(move, *(20 - times)), atol=0.02)


def test_a_stretched_move_has_its_ramps_stretched():
    move, factor = stretch({PAN: [Key(0, 0, leave=Ramp(0.5)), Key(2, 160)]}, LIMITS)
    assert factor > 1.2
    assert speeds(move, 0.5 * factor)[0] == pytest.approx(speeds(move, factor)[0], rel=0.05)


ramps = st.one_of(st.none(), st.floats(0, 5).map(Ramp), st.floats(0, 0.5).map(lambda share: Ramp(share=share)))


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(st.tuples(st.floats(0.5, 8), st.floats(-150, 150), st.booleans(), ramps, ramps), min_size=2, max_size=7)
)
def test_limits_hold_and_keys_are_met_whatever_the_ramps(drawn):
    at, keys = 0.0, []
    for seconds, position, stop, arrive, leave in drawn:
        keys.append(Key(at, position, stop, arrive=arrive, leave=leave))
        at += seconds
    try:
        move = plan({PAN: keys}, LIMITS)
    except Infeasible:
        return
    peaks = move.peaks()[PAN]
    assert peaks.velocity <= 60
    assert peaks.acceleration <= 120
    assert peaks.jerk <= 600
    for key in keys:
        assert move.at(key.at)[PAN].position == pytest.approx(key.position, abs=1e-3)


def test_a_way_that_the_hunt_found_hard_is_planned_or_refused_with_a_reason() -> None:
    """`hunt_plan.py --seed 21`, case 7668: two thousandths of a degree in a minute, after ramps of 0 s."""
    keys = [
        Key(0, 70, hold=0.5, where="key 1", leave=Ramp(0.0)),
        Key(5.5, 45, where="key 2", arrive=Ramp(1.916)),
        Key(65.5, 45.002, where="key 3"),
    ]
    limits, refusal = Limits(-180, 180, 120, 480, 1200), Infeasible([])
    try:
        move = plan({PAN: keys}, {PAN: limits}, 0.5)
    except Infeasible as error:
        refusal, move = error, None
    assert refusal.findings if move is None else move.at(65.5)[PAN].position == pytest.approx(45.002)


def test_a_ramp_too_short_for_the_solver_is_no_reason_to_refuse() -> None:
    """`hunt_plan.py --seed 101`, case 14594: a turn after 0.002 degrees got a ramp of 1 ms, beside 76 degrees."""
    keys = [
        Key(0, -180, where="key 1", leave=Ramp(0.5)),
        Key(3.316, -104, where="key 2", arrive=Ramp(1.418)),
        Key(7.316, -103.998, where="key 3", arrive=Ramp(0.0), leave=Ramp(share=0.18)),
        Key(12.316, -115.056, where="key 4", leave=Ramp(0.5)),
    ]
    move = plan({PAN: keys}, {PAN: Limits(-180, 180, 120, 240, 2400)}, 1.0)
    assert [move.at(key.at)[PAN].position for key in keys] == pytest.approx([key.position for key in keys])
    assert not move.overshoots


def test_ramps_that_nearly_meet_are_no_reason_to_refuse() -> None:
    """`hunt_refusals.py --seed 4`, file 1: 20 ms between two ramps of 0.8 s."""
    ease = Ramp(1.0)
    positions = {0: -1.4, 1.58: 29, 6.7: 6.5, 10.32: -22}
    keys = [Key(at, position, arrive=ease, leave=ease) for at, position in positions.items()]
    assert not plan({Axis.ROLL: keys}, {Axis.ROLL: Limits(-30, 30, 40, 90, 480)}).overshoots


def test_an_axis_that_the_solver_finds_no_way_for_is_refused_and_never_left_out() -> None:
    """Found at random: it was a move of 0 s, in which pan stayed where it was."""
    none = Ramp(0.0)
    keys = [
        Key(0, 70, where="key 1", leave=none),
        Key(1, 0, where="key 2"),
        Key(9, 0.002, where="key 3", arrive=none),
    ]
    tilt = [Key(0, 0), Key(4, 10)]
    wide = Limits(-180, 180, 120, 240, 1200)
    with pytest.raises(Infeasible, match=r"^pan needs [\d.]+ s from key 1 to key 2, not 1.000 s"):
        plan({PAN: keys, Axis.TILT: tilt}, {PAN: wide, Axis.TILT: wide})
