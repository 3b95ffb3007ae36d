"""A pad in the hand, by way of the kernel: uhid to hidraw to `teleop live` to a CAN bus to the simulated gimbal.

Three processes and a third node on the bus, which measures what became of the hand: while it moves the stick, when the
pad is torn out in the middle of a pan, and after it was plugged in again.
"""

from __future__ import annotations

import itertools
import json
import subprocess
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from bus_listener import BusListener
from command import running
from network import own_network
from uhid import Pad, plugged_in

DEVICES = json.loads((Path(__file__).parents[1] / "data" / "hid.json").read_text())["devices"]
[GAMEPAD] = [device for device in DEVICES if device["name"].startswith("Gravis")]  # X, Y, ten buttons in two bytes
NAME = "the pad"

RESTING = bytes.fromhex("7f7f0000")
ENABLED = bytes.fromhex("7f7f1000")
RIGHT = bytes.fromhex("ff7f1000")  # full stick, the enable button held
RIGHT_ALONE = bytes.fromhex("ff7f0000")

LINK = "gimbal=socketcan:vcan0"
FAST = 120.0  # deg/s, the pan's
RAMP = 25.0, 70.0  # deg from full speed to rest: 30 by its acceleration, more by its jerk and until it is noticed
PROFILE = f"""
name: A pad in the hand
links: {{gimbal: "sim:"}}
axes:
  pan: {{min: null, max: null, velocity: {FAST}, acceleration: 240, jerk: 1200}}
inputs:
  - device: {{vendor: {GAMEPAD["vendor_id"]}, product: {GAMEPAD["product_id"]}}}
    name: {NAME}
    enable: Button 5
    controls: {{X: {{axis: pan}}}}
sticks: {{ranges: [1.0]}}
sinks:
  - {{type: gimbal, link: gimbal, mode: position, rate: 50}}
"""


class Scene:
    """A pad and a run that it drives, watched from the bus."""

    def __init__(self, pad: Pad, live: subprocess.Popen[str], bus: BusListener) -> None:
        self.pad, self.bus = pad, bus
        self._said: list[str] = []
        self._heard = 0
        threading.Thread(target=self._listen, args=(live,), name="listener", daemon=True).start()

    def hear(self, words: str) -> str:
        """The next line of the run that has these words."""
        self.bus.until(lambda: any(words in line for line in self._said[self._heard :]), repr(words), self._said)
        while True:
            self._heard += 1
            if words in self._said[self._heard - 1]:
                return self._said[self._heard - 1]

    def _listen(self, live: subprocess.Popen[str]) -> None:
        assert live.stderr is not None
        self._said.extend(live.stderr)

    def drive(self) -> None:
        """Enable, full stick to the right, and full speed."""
        self.pad.show(ENABLED)
        self.bus.more(10)
        begin = self.bus.pan
        self.pad.show(RIGHT)
        self.bus.until(lambda: turned(begin, self.bus.pan) > 60, "a pan by 60 degrees")

    def still(self) -> bool:
        """Whether the gimbal stays where it is, over ten of its answers."""
        return len({angle.pan for angle in self.bus.more(10)}) == 1


def turned(begin: float, end: float) -> float:
    """Degrees to the right, of less than half a turn either way."""
    return (end - begin + 180) % 360 - 180


@pytest.fixture
def scene(tmp_path: Path) -> Iterator[Scene]:
    (tmp_path / "rig.yaml").write_text(PROFILE)
    options = "--rig", str(tmp_path / "rig.yaml"), "--presets", str(tmp_path / "presets.yaml"), "--link", LINK
    with ExitStack() as stack:
        stack.enter_context(own_network("link add dev vcan0 type vcan", "link set vcan0 up"))
        pad = stack.enter_context(plugged_in(GAMEPAD, RESTING))
        sim = stack.enter_context(running("sim", "--link", LINK))
        assert sim.stdout is not None
        assert "simulated gimbal" in sim.stdout.readline()
        bus = stack.enter_context(BusListener("vcan0"))
        scene = Scene(pad, stack.enter_context(running("live", *options)), bus)
        bus.more(10)
        yield scene


def test_a_pad_torn_out_in_a_pan_stops_it_smoothly_and_moves_nothing_until_it_is_enabled_again(scene: Scene) -> None:
    scene.drive()
    begin = len(scene.bus.angles)
    scene.pad.unplug()
    assert "unplugged: pan stopped" in scene.hear("unplugged")
    scene.bus.until(scene.still, "rest")
    angles = [angle.pan for angle in scene.bus.angles[begin - 1 :]]
    steps = [turned(one, other) for one, other in itertools.pairwise(angles)]
    assert min(steps) >= 0, f"it turned back: {angles}"
    assert RAMP[0] < sum(steps) < RAMP[1], angles
    assert len([step for step in steps if step > 0]) > 5, f"it stopped at once: {angles}"

    with plugged_in(GAMEPAD, RIGHT) as again:
        scene.pad = again
        scene.hear(f"{NAME}: center its sticks")
        assert scene.still(), "a stick that was never seen centred moved the pan"
        again.show(RESTING)
        scene.bus.more(10)
        again.show(RIGHT_ALONE)
        assert scene.still(), "a pad that was not enabled again moved the pan"
        again.show(RESTING)
        scene.drive()
        again.show(RESTING)
        scene.bus.until(scene.still, "rest")
