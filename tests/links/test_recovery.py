"""A bus that fails in the middle of a run and comes back while the loop still tries to give speed control back."""

from collections.abc import Callable
from pathlib import Path

import can.interfaces
import pytest
from fakes import cruising
from faulty_bus import FaultyBus, register

from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.run_state import Result, RunState
from teleop.core.shutdown import RELEASE_PATIENCE
from teleop.devices.rig import open_rig
from teleop.links import open_link
from teleop.sim.gimbal.device import SimulatedGimbal

PROFILE = """
name: Faulty
links: {gimbal: "faulty:demo"}
axes: {pan: {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 2400}}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50}]
"""


class HookedClock(VirtualClock):
    """Calls `hook` whenever time has passed."""

    def __init__(self) -> None:
        super().__init__()
        self.hook: Callable[[float], None] = lambda _now: None

    def sleep_until(self, time: float) -> None:
        super().sleep_until(time)
        self.hook(self.now())


@pytest.mark.parametrize(("outage", "given_back"), [(RELEASE_PATIENCE * 0.6, True), (RELEASE_PATIENCE * 2, False)])
def test_speed_control_is_given_back_when_the_bus_recovers_in_time(
    outage: float, given_back: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`outage` is how long (s) the bus stays full once the loop has begun to release."""
    register(monkeypatch)
    monkeypatch.setattr(can.interfaces, "VALID_INTERFACES", can.interfaces.VALID_INTERFACES | {"faulty"})
    (tmp_path / "rig.yaml").write_text(PROFILE)
    clock, gimbal = HookedClock(), SimulatedGimbal()
    far = open_link("virtual:demo", host=False, now=clock.now)
    releasing_since: list[float] = []

    with open_rig(load_profile(str(tmp_path / "rig.yaml")), clock) as rig:
        loop = rig.loop([Axis.PAN], [cruising(Axis.PAN, 20.0, 5.0)])

        def pass_bytes(now: float) -> None:
            if loop.supervisor.state is RunState.RELEASING:
                releasing_since.append(now)
            back = releasing_since and now - releasing_since[0] > outage
            FaultyBus.opened[-1].room = 0 if now > 1.0 and not back else 1 << 30
            gimbal.receive(far.receive(), now)
            if said := gimbal.advance(now):
                far.send(said)

        clock.hook = pass_bytes
        ended = loop.run()
        pass_bytes(clock.now())
    far.close()
    assert ended.result is Result.FAILED
    assert ended.reasons[0] == "faulty:demo: nothing has left for 250 ms, the bus is full or off"
    assert gimbal.controlled is not given_back
