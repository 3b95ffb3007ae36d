"""Random operators, pilots and cables on virtual time: whatever they do, the monitor finds nothing."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from drone_fault_bench import FLIGHT, VIRTUAL_RC, DroneFaultBench, drone_fault_bench
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from teleop.core.axes import STICKS
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.devices.drone.engagement import Stage
from teleop.sim.drone.controls import Pilot, Switch


def impatient(bench: DroneFaultBench) -> None:
    """Engages, gives back, and wants it again at once."""
    now = bench.clock.now() - bench.begin
    bench.engage_at(now)
    bench.at(now + 0.4, lambda: bench.keys.press(Command.DISENGAGE))
    bench.engage_at(now + 1.2)


ACTS: Mapping[str, Callable[[DroneFaultBench], object]] = {
    "engage": lambda bench: bench.keys.press(Command.ENGAGE),
    "impatient": impatient,
    "disengage": lambda bench: bench.keys.press(Command.DISENGAGE),
    "forward": lambda bench: bench.pad.hold(**dict.fromkeys(STICKS, 0.8)),
    "centre": lambda bench: bench.pad.hold(**dict.fromkeys(STICKS, 0.0)),
    "arm": lambda bench: bench.keys.press(Command.TELL, device_command=DeviceCommand("drone", "arm")),
    "mode": lambda bench: bench.keys.press(Command.TELL, device_command=DeviceCommand("drone", "mode-a")),
    "stale": lambda bench: setattr(bench.pad, "trouble", "silent for 0.2 s"),
    "back": lambda bench: setattr(bench.pad, "trouble", ""),
    "stop": lambda bench: bench.keys.press(Command.STOP),
    "clear": lambda bench: bench.keys.press(Command.CLEAR),
    "leave f": lambda bench: bench.drone.turn_switch(bench.clock.now(), Switch.P),
    "to f": lambda bench: bench.drone.turn_switch(bench.clock.now(), Switch.F),
    "deaf": lambda bench: setattr(bench.cable, "deaf", not bench.cable.deaf),
    "mute": lambda bench: setattr(bench.cable, "mute", not bench.cable.mute),
    "unplug": lambda bench: setattr(bench.cable, "unplugged", True),
    "stall": lambda bench: bench.clock.stall(0.24),
    "hide": lambda bench: bench.drone.hide("control"),
    "show": lambda bench: bench.drone.hide(),
}
STEPS = st.lists(
    st.tuples(
        st.sampled_from(["engage"] * 4 + ["impatient"] * 3 + ["forward"] * 3 + ["centre"] * 3 + [*ACTS]),
        st.sampled_from([0.05, 0.5, 1.5]),
    ),
    max_size=18,
)
SHORT = 0.05  # s
LOST_RELEASE = [  # the release leaves while nothing reaches the drone, which hears again just before the end
    *[("engage", SHORT)] * 3,
    ("deaf", SHORT),
    ("engage", SHORT),
    ("disengage", SHORT),
    *[("engage", SHORT)] * 7,
    ("engage", 0.5),
    *[("engage", SHORT)] * 2,
    ("deaf", SHORT),
]


@pytest.mark.parametrize("sink", [VIRTUAL_RC, FLIGHT], ids=["virtual-rc", "flight"])
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(steps=STEPS)
@example(steps=LOST_RELEASE)
def test_nothing_flies_by_accident(sink: str, steps: list[tuple[str, float]]) -> None:
    with tempfile.TemporaryDirectory() as folder, drone_fault_bench(Path(folder), sink) as bench:
        bench.airborne()
        now = 2.0
        for name, seconds in steps:
            bench.at(now, lambda act=ACTS[name]: act(bench))
            now += seconds
        bench.quit_at(now)
        bench.run(after=3.0)  # and its monitor looks at all that was sent
        stage = bench.sink.state(bench.clock.now()).stage
        assert stage in (Stage.IDLE.value, Stage.LEAVING.value, Stage.UNCONFIRMED.value)
        if stage == Stage.UNCONFIRMED.value:
            assert any("take it over with its RC" in reason for reason in bench.ended.reasons), "it is named"
        engages = sum({"engage": 1, "impatient": 2}.get(name, 0) for name, _ in steps)
        assert len(bench.enables) <= engages, "only by an operator's act"
        assert bench.drone.autopilot.pilot in (Pilot.RC, Pilot.ONBOARD), "its pilot has it, or it hovers"
        assert bench.cable.unplugged or bench.cable.deaf or bench.drone.autopilot.pilot is Pilot.RC
        if bench.said and bench.said[-1].endswith("is released: the drone confirms it"):
            assert bench.drone.autopilot.pilot is Pilot.RC, "nothing is called confirmed that is not"
        assert not bench.drone.autopilot.flight.crashed
