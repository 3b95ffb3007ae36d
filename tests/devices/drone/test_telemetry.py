"""Bringing a drone up, and what is kept of what it says, over the frames of a simulated one."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.core.errors import DeviceError, LinkError, TeleopError
from teleop.devices.connection import Connection
from teleop.devices.drone.engagement import Stage
from teleop.devices.drone.state import drone_state
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ActivationCode
from teleop.dji.drone.session import OnboardSession
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.link import SimLink


class Bench:
    def __init__(self, **settings: Any) -> None:
        self.now = 0.0
        self.drone = SimulatedDrone(**settings)
        link = SimLink(self.drone, lambda: self.now)
        self.telemetry = Telemetry(Connection("drone", "sim:", link, 0.0, None, OnboardSession()), drone.Activate(1))

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds * 100)):
            self.now = round(self.now + 0.01, 6)
            self.telemetry.service(self.now)


def test_it_is_activated_and_asked_for_the_field_with_the_bit() -> None:
    bench = Bench()
    bench.run(0.1)
    assert bench.telemetry.activated
    bench.run(1)
    assert bench.telemetry.get("control", bench.now).virtual_rc is False
    assert bench.telemetry.get("battery", bench.now) == 100
    assert bench.telemetry.get("acceleration", bench.now) is None, "not asked for"


def test_an_old_word_is_none() -> None:
    bench = Bench()
    bench.run(1.2)
    bench.drone.hide("status", "battery")
    bench.run(0.25)
    assert bench.telemetry.get("status", bench.now) is not None
    assert bench.telemetry.get("status", bench.now, 0.2) is None
    bench.run(1)
    assert bench.telemetry.get("status", bench.now) is None
    assert bench.telemetry.get("battery", bench.now) == 100, "it comes once a second"
    bench.run(3)
    assert bench.telemetry.get("battery", bench.now) is None


def refuse(bench: Bench) -> None:
    bench.drone._handlers[drone.Activate] = lambda _message: drone.ActivateAck(ActivationCode.NO_INTERNET)


def mute(bench: Bench) -> None:
    bench.drone.acknowledges = False


def mute_later(bench: Bench) -> None:
    bench.drone._handlers[drone.Activate] = lambda _message: None


@pytest.mark.parametrize(
    ("spoil", "error", "said", "within"),
    [
        (refuse, DeviceError, "the drone refuses to be activated: no internet", 0.2),
        (mute, LinkError, "drone on sim: does not answer: is it on, is the cable in?", 0.4),
        (mute_later, LinkError, "drone on sim: does not answer when asked to activate it: is it on, is", 3.2),
    ],
)
def test_what_ends_bringing_up_is_said_once(spoil, error: type[TeleopError], said: str, within: float) -> None:
    bench = Bench()
    spoil(bench)
    with pytest.raises(error, match=said.replace("?", r"\?")):
        bench.run(within)
    bench.run(5)
    assert not bench.telemetry.activated


def test_its_state_has_everything_in_units() -> None:
    bench = Bench(yaw=90.0, battery=80.0)
    bench.drone.autopilot.flight.hover(12)
    bench.run(1.2)
    bench.drone.autopilot.flight.fly(3 + 0j)
    bench.run(3)
    state = drone_state(bench.telemetry, bench.now, Stage.IDLE, {})
    assert state.attitude == (pytest.approx(0, abs=0.5), pytest.approx(0, abs=0.5), pytest.approx(90))
    assert state.velocity == (pytest.approx(0, abs=0.01), pytest.approx(3, abs=0.05), pytest.approx(0))
    assert (state.height, state.battery, state.status) == (pytest.approx(12), 80, "in air")
    assert (state.rc, state.rc_mode, state.device, state.virtual_rc) == ((0, 0, 0, 0), "F", "remote controller", False)
    assert (state.latitude, state.longitude) == (pytest.approx(52.5), pytest.approx(13.4, abs=1e-3))
    bench.drone.hide("quaternion", "velocity", "position", "rc", "gimbal", "status", "battery", "control")
    bench.run(4)
    silent = drone_state(bench.telemetry, bench.now, Stage.IDLE, {})
    assert (silent.attitude, silent.height, silent.battery, silent.status, silent.virtual_rc) == (None,) * 5
