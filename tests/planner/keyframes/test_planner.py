"""What a planned move promises, checked without the planner's own arithmetic wherever that is possible."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.planner.keyframes.findings import Finding, Infeasible, PlanError
from teleop.planner.keyframes.planner import Key, plan, stretch

PAN, TILT, FOCUS = Axis.PAN, Axis.TILT, Axis.FOCUS
LIMITS = Limits(-170, 170, 60, 120, 600)
ALL = {PAN: LIMITS, TILT: Limits(-30, 40, 40, 90, 480), FOCUS: Limits(0, 1, 0.8, 3, 20)}


def one(*keys, tension=0.0, limits=LIMITS):
    return plan({PAN: keys}, {PAN: limits}, tension)


@st.composite
def key_lists(draw, gentlest=1.0):
    """Keys whose durations are `gentlest`..5 times what a rest-to-rest quintic needs."""
    steps = draw(st.lists(st.floats(-60, 60), min_size=1, max_size=8))
    keys = [Key(1.0, draw(st.floats(-100, 100)), where="key 1")]
    for number, step in enumerate(steps, start=1):
        position = min(max(keys[-1].position + step, -160.0), 160.0)
        distance = abs(position - keys[-1].position)
        rest = max(15 / 8 * distance / 57, (5.7735 * distance / 114) ** 0.5, (60 * distance / 570) ** (1 / 3), 0.05)
        at = keys[-1].at + keys[-1].hold + rest * draw(st.floats(gentlest, 5))
        stop, hold = draw(st.sampled_from([(False, 0.0), (False, 0.0), (True, 0.0), (False, 0.75)]))
        keys.append(Key(at, position, stop, hold, f"key {number + 1}"))
    return keys


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(key_lists(), st.sampled_from([0.0, 0.0, 0.5, 1.0]))
def test_keys_are_met_and_limits_hold_in_continuous_time(keys, tension):
    move = one(*keys, tension=tension)
    for key in keys:
        assert move.at(key.at)[PAN].position == pytest.approx(key.position, abs=1e-9)
        if key.stop or key.hold:
            assert move.at(key.at)[PAN] == pytest.approx(State(key.position), abs=1e-6)
            assert move.at(key.at + key.hold)[PAN] == pytest.approx(State(key.position), abs=1e-6)
    times = np.linspace(0, move.duration + 1, 20001)
    step = times[1]
    position, velocity, acceleration, jerk = move.sample(times)[PAN]
    assert np.abs(velocity).max() <= 60
    assert np.abs(acceleration).max() <= 120
    assert np.abs(jerk).max() <= 600
    # the rows are one motion: each is the integral of the next, so acceleration has no jumps
    assert np.abs(np.diff(position) - step * (velocity[1:] + velocity[:-1]) / 2).max() <= step**3 * 600
    assert np.abs(np.diff(velocity) - step * (acceleration[1:] + acceleration[:-1]) / 2).max() <= step**2 * 600
    assert np.abs(np.diff(acceleration)).max() <= step * 600


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(key_lists())
def test_nothing_overshoots_between_two_keys(keys):
    move = one(*keys)
    assume(not move.overshoots)
    for first, last in pairwise(keys):
        times = np.linspace(first.at, last.at, 500)
        position = move.sample(times)[PAN][0]
        assert position.min() >= min(first.position, last.position) - 1e-6
        assert position.max() <= max(first.position, last.position) + 1e-6


def test_generous_keys_never_need_to_overshoot():
    move = one(Key(0, 0), Key(2, 40), Key(4, 41), Key(6, -20), Key(9, -20), Key(12, 30))
    assert move.overshoots == ()


def test_overshoot_that_cannot_be_avoided_is_reported_with_its_size():
    # 40 deg/s into a key that the next, 0.1 deg on, leaves no room to brake at
    keys = [Key(0, 0, where="key 1"), Key(1.3, 40, where="key 2"), Key(1.6, 40.1, where="key 3")]
    move = one(*keys, Key(4, 40.2, where="key 4"))
    (overshoot, *_) = move.overshoots
    times = np.linspace(1.3, 1.6, 4001)
    if overshoot.first == "key 2":
        assert overshoot.size == pytest.approx(move.sample(times)[PAN][0].max() - 40.1, abs=1e-4)
    assert "overshoots by" in str(overshoot)
    assert str(overshoot).startswith("pan overshoots by ")


def test_a_hold_holds_exactly():
    move = one(Key(0, 0.1), Key(2, 20.3, hold=1.5), Key(6, -7.7))
    for time in np.linspace(2, 3.5, 31):
        assert move.at(time)[PAN] == State(20.3, 0.0, 0.0)


def test_equal_keys_stand_still_and_the_ends_are_exact():
    move = one(Key(1, 0.1), Key(3, 20.3), Key(5, 20.3), Key(7, 20.3), Key(9, 0.7))
    assert move.at(4.4)[PAN] == move.at(5.0)[PAN] == State(20.3)
    assert move.at(0.3)[PAN] == State(0.1)
    assert move.at(9.0)[PAN] == move.at(1e6)[PAN] == State(0.7)


def test_a_key_passed_through_is_not_a_stop():
    move = one(Key(0, 0), Key(3, 30), Key(6, 60))
    assert move.at(3)[PAN].velocity > 10


def test_axes_have_their_own_keys_and_one_key_is_a_constant():
    keys = {PAN: [Key(0, 0), Key(5, 50)], TILT: [Key(2, -10), Key(3, 0)], FOCUS: [Key(0, 0.4)]}
    move = plan(keys, ALL)
    assert move.duration == 5
    assert move.at(1)[TILT] == State(-10)
    assert move.at(4)[TILT] == State(0)
    assert move.at(2.2)[FOCUS] == State(0.4)


def test_tension_evens_the_speed_between_keys():
    keys = [Key(0, 0), Key(4, 40), Key(8, 60), Key(12, 110)]

    def ripple(tension):
        return one(*keys, tension=tension).sample(np.linspace(4, 8, 401))[PAN][1].std()

    assert ripple(1.0) < ripple(0.5) < ripple(0.0)


@pytest.mark.parametrize("seconds", [0.05, 1.0, 3600.0, 86400.0, 3e6])
def test_keys_any_time_apart(seconds):
    distance = min(100.0, 600 * seconds**3 / 100)
    keys = [Key(k * seconds, (k + (k % 2) / 3) * distance / 3) for k in range(4)]
    move = one(*keys)
    for key in keys:
        assert move.at(key.at)[PAN].position == pytest.approx(key.position, abs=1e-9)
    assert move.overshoots == ()
    peaks = move.peaks()[PAN]
    assert peaks.velocity * seconds < 10 * distance


def test_a_twitch_beside_a_day():
    keys = [Key(0, 0), Key(0.05, 0.001), Key(86400, 100), Key(86402, 110), Key(86402.05, 110.001)]
    for tension in (0.0, 0.5):
        move = one(*keys, tension=tension)
        for key in keys:
            assert move.at(key.at)[PAN].position == pytest.approx(key.position, abs=1e-6)
        peaks = move.peaks()[PAN]
        assert peaks.velocity <= 60
        assert peaks.acceleration <= 120
        assert peaks.jerk <= 600
        assert (peaks.minimum, peaks.maximum) == pytest.approx((0, 110.001), abs=1e-6)


def test_two_thousand_keys():
    rng = np.random.default_rng(4)
    at = np.cumsum(rng.uniform(1, 4, 2000))
    position = np.clip(np.cumsum(rng.uniform(-20, 20, 2000)), -160, 160)
    keys = [Key(float(t), float(p)) for t, p in zip(at, position, strict=True)]
    move = one(*keys)
    met = move.sample(at)[PAN][0]
    assert np.abs(met - position).max() < 1e-9


def test_a_continuous_axis_has_no_soft_limits():
    move = one(Key(0, 0), Key(60, 1000), Key(90, 700), limits=Limits(-np.inf, np.inf, 60, 120, 600))
    assert move.at(60)[PAN].position == pytest.approx(1000)


def test_a_key_beyond_a_soft_limit_is_named_with_all_others():
    keys = {
        PAN: [Key(0, 0, where="key 1"), Key(4, 190, where="key 2")],
        TILT: [Key(0, -31, where="key 1"), Key(4, 41, where="key 2")],
    }
    with pytest.raises(Infeasible) as refused:
        plan(keys, ALL)
    found = [(f.axis, f.first, f.limit, f.factor) for f in refused.value.findings if isinstance(f, Finding)]
    assert found == [
        (PAN, "key 2", "maximum", 20),
        (TILT, "key 1", "minimum", 1),
        (TILT, "key 2", "maximum", 1),
    ]


@pytest.mark.parametrize(
    "keys",
    [
        [Key(0, 0), Key(2, 10, where="key 2"), Key(1, 20, where="key 3")],
        [Key(0, 0), Key(2, 10, hold=3, where="key 2"), Key(4, 20, where="key 3")],
        [Key(0, 0), Key(2, 10, where="key 2"), Key(2, 20, where="key 3")],
    ],
)
def test_keys_out_of_order_are_refused(keys):
    with pytest.raises(PlanError, match=r"key 3.*is not after key 2"):
        one(*keys)


def test_a_dwell_may_end_at_the_next_key():
    move = one(Key(0, 0), Key(2, 10, hold=2), Key(4, 10), Key(6, 0))
    assert move.at(3)[PAN] == State(10)


def test_stretch_finds_the_least_factor_that_will_do():
    keys = {PAN: [Key(0, 0), Key(0.8, 40, hold=0.2), Key(2, 0)], TILT: [Key(0, 0), Key(2, 10)]}
    move, factor = stretch(keys, ALL)
    assert factor > 1
    assert move.duration == pytest.approx(2 * factor)
    assert move.at(0.9 * factor)[PAN] == State(40)
    shorter = {
        axis: [Key(k.at * factor * 0.99, k.position, k.stop, k.hold * factor * 0.99) for k in of_axis]
        for axis, of_axis in keys.items()
    }
    with pytest.raises(Infeasible):
        plan(shorter, ALL)


def test_stretch_leaves_alone_what_fits():
    keys = {PAN: [Key(0, 0), Key(4, 40)]}
    move, factor = stretch(keys, ALL)
    assert factor == 1
    assert move.duration == 4


def test_stretch_refuses_what_no_time_mends():
    with pytest.raises(Infeasible):
        stretch({PAN: [Key(0, 0), Key(4, 400)]}, ALL)
