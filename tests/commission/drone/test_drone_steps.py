"""A drone's commissioning against the simulated drone: the right facts come out of each variant of it."""

from __future__ import annotations

import math

import pytest
from drone_commission_bench import DroneCommissionBench
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from teleop.commission.drone.session_steps import RATE
from teleop.commission.findings import Verdict
from teleop.commission.page import Page
from teleop.dji.drone.enums import Rate
from teleop.sim.drone.controls import Switch
from teleop.sim.drone.settings import DroneSettings


def skipping(*keys: str) -> DroneCommissionBench:
    bench = DroneCommissionBench()

    def skips(page: Page) -> bool:
        return page.key in keys

    bench.operator.skips = skips
    return bench


def test_every_fact_of_the_documented_drone() -> None:
    bench = DroneCommissionBench()
    found = bench.run()
    assert bench.operator.troubles == []
    assert [fact.key for fact in found.facts if fact.verdict is Verdict.DIFFERENT] == []
    assert [fact.key for fact in found.facts if fact.verdict is Verdict.NOT_SEEN] == []
    values = {fact.key: fact.found for fact in found.facts}
    assert values["drone.version"] == "SDK-v1.0 BETA M100-03.01.01.00"
    assert values["virtual_rc.timeout"] == pytest.approx(1.0, abs=0.05)
    assert (values["rc.mode.a"], values["rc.mode.p"], values["rc.mode.f"]) == (0, -8000, 8000)
    assert {key: values[f"broadcast.rate.{key}"] for key in RATE} == {
        key: pytest.approx(subject.documented, rel=0.1) for key, subject in RATE.items()
    }
    assert values["virtual_rc.mirrored"] is False
    assert bench.bench.serial == "041D492163"
    assert not bench.drone.autopilot.virtual_on
    assert not bench.motors
    assert len(bench.longest) < 79  # a terminal of 80 columns


SIGNS = st.tuples(*[st.sampled_from((1, -1))] * 3)


@given(
    attitude=SIGNS,
    rates=SIGNS,
    climb=st.sampled_from((1, -1)),
    timeout=st.sampled_from((0.5, 1.0, 3.0)),
    early=st.booleans(),
    mirrors=st.booleans(),
)
@settings(max_examples=3, deadline=None, phases=[Phase.explicit, Phase.generate])
def test_signs_time_out_and_silence_of_any_drone(
    attitude: tuple[int, int, int],
    rates: tuple[int, int, int],
    climb: int,
    timeout: float,
    early: bool,
    mirrors: bool,
) -> None:
    of = DroneSettings(
        attitude_signs=attitude,
        rate_signs=rates,
        climb_sign=climb,
        virtual_rc_timeout=timeout,
        broadcasts_before_activation=early,
    )
    bench = DroneCommissionBench(of, tick=0.025, mirrors=mirrors)
    values = {fact.key: fact.found for fact in bench.run().facts}
    assert bench.operator.troubles == []
    assert tuple(values[f"sign.{name}"] for name in ("roll", "pitch", "yaw")) == attitude
    assert tuple(values[f"sign.rate.{name}"] for name in ("roll", "pitch", "yaw")) == rates
    assert (values["sign.climb"], values["sign.height"]) == (climb, True)
    assert values["virtual_rc.timeout"] == pytest.approx(timeout, abs=0.05)
    assert values["broadcast.early"] is early
    assert values["virtual_rc.mirrored"] is mirrors
    assert not bench.drone.autopilot.virtual_on


def test_a_drone_that_never_ends_virtual_rc_by_itself_is_told_to() -> None:
    bench = DroneCommissionBench(DroneSettings(virtual_rc_timeout=50.0))
    bench.operator.skips = lambda page: page.key in ("signs", "fields", "virtual-rc")
    fact = bench.run()["virtual_rc.timeout"]
    assert (fact.found, fact.verdict) == (5.0, Verdict.DIFFERENT)
    assert not bench.drone.autopilot.virtual_on


def test_without_a_control_field_virtual_rc_is_not_seen_and_is_ended() -> None:
    bench = skipping("signs", "fields")
    bench.drone.hide("control")
    found = bench.run()
    for key in ("virtual_rc.on", "virtual_rc.kept", "virtual_rc.off", "virtual_rc.timeout", "broadcast.rate.control"):
        assert found[key].verdict is Verdict.NOT_SEEN, key
    assert not bench.drone.autopilot.virtual_on


def test_a_drone_that_is_not_turned_leaves_its_signs_unseen() -> None:
    bench = skipping("mode-switch")
    bench.operator.hands = False
    found = bench.run()
    assert {found[f"sign.{name}"].verdict for name in ("roll", "pitch", "yaw", "climb", "rate.yaw")} == {
        Verdict.NOT_SEEN
    }


def test_without_the_switch_in_f_virtual_rc_is_not_tried() -> None:
    bench = skipping("mode-switch", "signs", "fields")
    found = bench.run()
    assert found["virtual_rc.on"].how == "the mode switch of the RC was not seen in F"
    assert not any(frame.data[:1] == b"\x05" for _, frame in bench.sent)


def test_a_switch_that_left_f_again_refuses_virtual_rc() -> None:
    bench = skipping("signs", "fields")

    def leave_f(bench: DroneCommissionBench) -> None:
        if bench.runner.page.key == "virtual-rc":
            bench.drone.turn_switch(bench.clock.now(), Switch.P)

    bench.watch = leave_f
    bench.run()
    assert "the RC's mode switch is not in F" in bench.operator.troubles[0]
    assert not any(frame.data[:1] == b"\x05" for _, frame in bench.sent)


def test_a_drone_in_the_air_is_refused_at_once() -> None:
    bench = DroneCommissionBench()
    bench.drone.turn_switch(100.0, Switch.F)
    bench.drone.autopilot.obtain()
    assert bench.drone.autopilot.take_off()
    for _ in range(500):
        bench.drone.advance(bench.clock.now())
        bench.clock.sleep_until(bench.clock.now() + 0.01)
    bench.run()
    assert bench.runner.reason.startswith("the drone reports that it flies")
    assert bench.sent == []


def test_an_activation_that_is_refused_leaves_the_rest_unseen(monkeypatch: pytest.MonkeyPatch) -> None:
    from teleop.dji.drone import messages as drone
    from teleop.dji.drone.enums import ActivationCode

    bench = DroneCommissionBench()
    handlers = bench.drone._handlers
    monkeypatch.setitem(handlers, drone.Activate, lambda _message: drone.ActivateAck(ActivationCode.NEW_DEVICE))
    found = bench.run()
    assert found["drone.activated"].how == "it answered: new device"
    assert found["broadcast.frequencies"].how == "the drone is not activated"


def test_rates_that_are_not_obeyed_are_different() -> None:
    bench = skipping("signs", "mode-switch")
    sender = bench.drone._telemetry
    sender.set = lambda _message: sender.rates.update(velocity=Rate.HZ_1)  # type: ignore[method-assign]
    fact = bench.run()["broadcast.rate.velocity"]
    assert fact.verdict is Verdict.DIFFERENT
    assert fact.found == pytest.approx(1.0, abs=0.4)
    assert not math.isnan(float(fact.found or 0))


def test_a_switch_that_is_not_turned_is_seen_in_f_alone() -> None:
    bench = DroneCommissionBench(switch=Switch.F)
    bench.operator.skips = lambda page: page.key in ("signs", "fields")
    bench.drone.turn_switch = lambda now, switch: None  # type: ignore[method-assign]
    found = bench.run()
    assert [found[f"rc.mode.{name}"].found for name in "apf"] == [None, None, 8000]
    assert found["virtual_rc.off"].found is True
