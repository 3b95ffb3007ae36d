"""Random operators, pilots and cables on virtual time: whatever they do, the monitor finds nothing."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from sky import FLIGHT, VIRTUAL_RC, Sky, sky

from teleop.core.axes import STICKS
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.devices.drone.engagement import Stage
from teleop.sim.drone.controls import Pilot, Switch


def impatient(scene: Sky) -> None:
    """Engages, gives back, and wants it again at once."""
    now = scene.clock.now() - scene.begin
    scene.engage_at(now)
    scene.at(now + 0.4, lambda: scene.keys.press(Command.DISENGAGE))
    scene.engage_at(now + 1.2)


ACTS: Mapping[str, Callable[[Sky], object]] = {
    "engage": lambda scene: scene.keys.press(Command.ENGAGE),
    "impatient": impatient,
    "disengage": lambda scene: scene.keys.press(Command.DISENGAGE),
    "forward": lambda scene: scene.pad.hold(**dict.fromkeys(STICKS, 0.8)),
    "centre": lambda scene: scene.pad.hold(**dict.fromkeys(STICKS, 0.0)),
    "arm": lambda scene: scene.keys.press(Command.TELL, device_command=DeviceCommand("drone", "arm")),
    "mode": lambda scene: scene.keys.press(Command.TELL, device_command=DeviceCommand("drone", "mode-a")),
    "stale": lambda scene: setattr(scene.pad, "trouble", "silent for 0.2 s"),
    "back": lambda scene: setattr(scene.pad, "trouble", ""),
    "stop": lambda scene: scene.keys.press(Command.STOP),
    "clear": lambda scene: scene.keys.press(Command.CLEAR),
    "leave f": lambda scene: scene.drone.turn_switch(scene.clock.now(), Switch.P),
    "to f": lambda scene: scene.drone.turn_switch(scene.clock.now(), Switch.F),
    "deaf": lambda scene: setattr(scene.cable, "deaf", not scene.cable.deaf),
    "mute": lambda scene: setattr(scene.cable, "mute", not scene.cable.mute),
    "unplug": lambda scene: setattr(scene.cable, "unplugged", True),
    "stall": lambda scene: scene.clock.stall(0.24),
    "hide": lambda scene: scene.drone.hide("control"),
    "show": lambda scene: scene.drone.hide(),
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
    with tempfile.TemporaryDirectory() as folder, sky(Path(folder), sink) as scene:
        scene.airborne()
        now = 2.0
        for name, seconds in steps:
            scene.at(now, lambda act=ACTS[name]: act(scene))
            now += seconds
        scene.quit_at(now)
        scene.run(after=3.0)  # and its monitor looks at all that was sent
        stage = scene.sink.state(scene.clock.now()).stage
        assert stage in (Stage.IDLE.value, Stage.LEAVING.value, Stage.UNCONFIRMED.value)
        if stage == Stage.UNCONFIRMED.value:
            assert any("take it over with its RC" in reason for reason in scene.ended.reasons), "it is named"
        engages = sum({"engage": 1, "impatient": 2}.get(name, 0) for name, _ in steps)
        assert len(scene.enables) <= engages, "only by an operator's act"
        assert scene.drone.cockpit.pilot in (Pilot.RC, Pilot.ONBOARD), "its pilot has it, or it hovers"
        assert scene.cable.unplugged or scene.cable.deaf or scene.drone.cockpit.pilot is Pilot.RC
        if scene.said and scene.said[-1].endswith("is given back: the drone confirms"):
            assert scene.drone.cockpit.pilot is Pilot.RC, "nothing is called confirmed that is not"
        assert not scene.drone.cockpit.flight.crashed
