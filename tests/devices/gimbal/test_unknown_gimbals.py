"""Gimbals that nobody has measured, in whole runs: bytes on the wire of the simulated one, the clock virtual.

The hunt over hundreds of them is tests/benchmarks/unknown_gimbals.py.
"""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plant_bench import PAN, TracedGimbal, into_limit, keyed, profile_of, run, stick
from unknown_gimbal import UnknownGimbal

from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.sim.gimbal.dynamics import Dynamics

BEYOND, FIRST, SECOND = 0.5, 0.6, 0.3  # deg
TABLE = (
    Dynamics(lag=0.05),
    Dynamics(lag=0.12),
    Dynamics(lag=0.03, dead_time=0.08),
    Dynamics(lag=0.08, gain=0.92),
    Dynamics(lag=0.05, drift=0.5),
    Dynamics(lag=0.2),
    Dynamics(lag=0.2, dead_time=0.1, gain=1.1, drift=1.0),
)
UNKNOWN = st.builds(
    Dynamics,
    lag=st.floats(0.03, 0.2),
    dead_time=st.floats(0.0, 0.1),
    gain=st.floats(0.85, 1.1),
    drift=st.floats(-1.0, 1.0),
)


@pytest.mark.parametrize(("dynamics", "limit"), [*((each, 60) for each in TABLE), (TABLE[-1], 180)], ids=str)
def test_a_soft_limit_holds_at_the_first_approach(dynamics: Dynamics, limit: float) -> None:
    beyond, ran = into_limit(dynamics, profile_of(pan={**PAN, "max": limit}))
    assert -1.0 < beyond <= BEYOND
    assert not ran.reasons
    assert all("slowed down to stop at its soft limit" in note for note in ran.notes)
    assert len(ran.notes) <= 2


@pytest.mark.parametrize("dynamics", [TABLE[1], TABLE[2], TABLE[3], TABLE[6]], ids=str)
def test_keys_are_met_in_the_first_run_and_better_in_the_second(dynamics: Dynamics) -> None:
    first, ran = keyed(dynamics, profile_of())
    assert first <= FIRST
    found = ran.responses[Axis.PAN]
    assert found.delay == pytest.approx(dynamics.dead_time + dynamics.lag, abs=0.02)
    second, again = keyed(dynamics, profile_of(), priors=ran.responses)
    assert second <= SECOND
    assert not ran.notes + again.notes


BRISK = {**PAN, "velocity": 100, "acceleration": 400, "jerk": 4000}


@pytest.mark.parametrize(("gain", "start"), [(0.85, -20.0), (1.1, -8.0)])
def test_after_a_short_brisk_ease_the_first_key_is_met_all_the_same(gain: float, start: float) -> None:
    """The slowest gimbals with the most drift: until an axis rests, a drift looks like a gain. It rests longer here."""
    dynamics = Dynamics(lag=0.2, dead_time=0.1, gain=gain, drift=1.0)
    first, ran = keyed(dynamics, profile_of(pan=BRISK), start)
    assert first <= FIRST
    second, again = keyed(dynamics, profile_of(pan=BRISK), start, priors=ran.responses)
    assert second <= SECOND
    assert again.begin == pytest.approx(ran.begin - 0.3, abs=0.05), "one that is known rests for four times its delay"


@pytest.mark.parametrize("known", [{"mode": "position"}, {"mode": "speed", "delay": 0.05}], ids=str)
def test_no_other_rig_rests_longer(known: dict[str, Any]) -> None:
    _, unknown = keyed(Dynamics(lag=0.05), profile_of())
    _, again = keyed(Dynamics(lag=0.05), profile_of(), priors=unknown.responses)
    _, other = keyed(Dynamics(lag=0.05), profile_of(**known))
    assert other.begin == again.begin == pytest.approx(unknown.begin - 1.0)


@settings(max_examples=3, deadline=None)
@given(UNKNOWN, st.sampled_from([25, 50, 100]), st.sampled_from(["speed", "stick"]))
def test_whatever_the_gimbal(dynamics: Dynamics, rate: int, mode: str) -> None:
    setting: dict[str, Any] = {"full_stick": {"pan": 120.0}} if mode == "stick" else {}
    beyond, _ = into_limit(dynamics, profile_of(mode, rate, {**PAN, "max": 60}, **setting))
    assert beyond <= BEYOND
    first, ran = keyed(dynamics, profile_of(mode, rate, **setting))
    assert first <= FIRST
    assert keyed(dynamics, profile_of(mode, rate, **setting), priors=ran.responses)[0] <= SECOND


def test_pushes_alone_will_do() -> None:
    rate = 100
    dynamics = Dynamics(lag=0.1, dead_time=0.05, gain=0.95, drift=0.3)
    beyond, _ = into_limit(dynamics, profile_of(rate=rate), make=UnknownGimbal, pushes_at=25)
    assert beyond <= BEYOND
    first, ran = keyed(dynamics, profile_of(rate=rate), make=UnknownGimbal, pushes_at=25)
    assert first <= FIRST
    assert keyed(dynamics, profile_of(rate=rate), make=UnknownGimbal, pushes_at=25, priors=ran.responses)[0] <= SECOND


@pytest.mark.parametrize("delay", [0.0, 0.05, 0.4])
def test_a_wrong_delay_in_the_profile_breaks_no_soft_limit(delay: float) -> None:
    beyond, _ = into_limit(Dynamics(lag=0.2, dead_time=0.1, gain=1.1), profile_of(delay=delay))
    assert beyond <= BEYOND


def test_a_prior_of_another_gimbal_breaks_no_soft_limit_and_is_dropped_aloud() -> None:
    prior = {Axis.PAN: Response(0.0, 0.03, 1.0, 0.0, 0.006, 0.01, 0.05)}
    beyond, ran = into_limit(Dynamics(lag=0.2, dead_time=0.1), profile_of(), priors=prior)
    assert beyond <= BEYOND
    assert "pan answers otherwise than before: it is identified anew" in ran.notes


@pytest.mark.parametrize(("mode", "lag"), [("position", 0.05), ("stick", 0.0301)])
def test_position_mode_is_not_held_back_by_a_good_gimbal(mode: str, lag: float) -> None:
    setting: dict[str, Any] = {"full_stick": {"pan": 120.0}} if mode == "stick" else {}
    beyond, ran = into_limit(Dynamics(lag=lag), profile_of(mode, **setting), speed=40.0)
    assert beyond == pytest.approx(0.0, abs=0.06)
    if mode == "position":
        assert not ran.notes


def test_an_axis_that_drifts_beyond_a_limit_comes_back_gently() -> None:
    gimbal = TracedGimbal(Dynamics(lag=0.05, drift=0.8), (59.9, 0.0, 0.0))
    ran = run(gimbal, profile_of(pan={**PAN, "max": 60}), [stick(0.0, 0.0, 8.0)])
    assert ran.highest <= 60 + BEYOND
    assert gimbal.angles.yaw == pytest.approx(59.9, abs=0.15)


def test_an_axis_that_is_let_go_at_rest_makes_no_lunge() -> None:
    gimbal = TracedGimbal(Dynamics(lag=0.05), (0.0, 0.0, 0.0))

    def hand(tick: Tick) -> None:
        time = tick.time - 100
        gimbal.hold(tick.time, yaw=1.0 < time < 1.5)

    ran = run(gimbal, profile_of(), [stick(8.0, 1.4, 8.0)], hook=hand)
    after = [place for time, place in gimbal.path if time > 101.5]
    assert not ran.reasons
    assert max(after) < 8.0 * 1.4 + 1.0
    assert after[-1] == pytest.approx(ran.ticks[-1].motion[Axis.PAN].position, abs=0.15)


def test_another_payload_in_mid_run_is_said_once_and_the_keys_are_met_again() -> None:
    light, heavy = Dynamics(lag=0.05), Dynamics(lag=0.2, dead_time=0.06, gain=0.9)
    keys = [{"at": f"{2 * number}s", "pan": 45 * (number % 2)} for number in range(9)]
    _, ran = keyed(light, profile_of(), keys=keys, changes=[(6.0, heavy)])
    assert ran.notes == ["pan answers otherwise than before: it is identified anew"]
    assert not ran.reasons
    assert ran.responses[Axis.PAN].delay == pytest.approx(0.26, abs=0.03)
    for number in (6, 7, 8):
        assert abs(ran.at(ran.begin + 2 * number) - 45 * (number % 2)) <= FIRST


def test_a_slow_axis_is_not_said_to_be_held_and_a_held_one_is() -> None:
    slow = Dynamics(lag=0.2, dead_time=0.1, gain=0.85)
    _, ran = into_limit(slow, profile_of(pan={**PAN, "max": 90, "acceleration": 400, "jerk": 4000}))
    assert not ran.reasons
    gimbal = TracedGimbal(slow, (0.0, 0.0, 0.0))

    def hand(tick: Tick) -> None:
        gimbal.hold(tick.time, yaw=tick.time > 101.0)

    ran = run(gimbal, profile_of(), [stick(40.0, 3.0)], hook=hand)
    assert [reason for reason in ran.reasons if reason.startswith("pan does not follow")]
