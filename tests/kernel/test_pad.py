"""A pad in the hand, by way of the kernel: uhid to hidraw, or uinput to an event device (what a wired Xbox pad is), to
`teleop live` to a CAN bus to the simulated gimbal.

Three processes and a third node on the bus, which measures what became of the hand: while it moves the stick, when the
pad is torn out in the middle of a pan, and after it was plugged in again.
"""

from __future__ import annotations

import itertools
import json
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from bus_listener import BusListener
from command import running
from fake_evdev import ABS, KEY
from network import own_network
from uhid import plugged_in
from uinput import event_pad

DEVICES = json.loads((Path(__file__).parents[1] / "data" / "hid.json").read_text())["devices"]
[GAMEPAD] = [device for device in DEVICES if device["name"].startswith("Gravis")]  # X, Y, ten buttons in two bytes
NAME = "the pad"

XBOX = 0x045E, 0x02EA
X, SHOULDER = (ABS, 0), (KEY, 0x136)


@dataclass(frozen=True)
class Kind:
    """A pad that a kernel can be made to have: how it is plugged in showing something, and what it can show."""

    plugged_in: Callable[[Any], AbstractContextManager[Any]]
    ids: tuple[int, int]
    enable: str
    resting: Any
    enabled: Any
    right: Any  # full stick, the enable button held
    right_alone: Any


REPORTS = [bytes.fromhex(report) for report in ("7f7f0000", "7f7f1000", "ff7f1000", "ff7f0000")]
EVENTS = [{}, {SHOULDER: 1}, {X: 32767, SHOULDER: 1}, {X: 32767}]
KINDS = {
    "hidraw": Kind(partial(plugged_in, GAMEPAD), (GAMEPAD["vendor_id"], GAMEPAD["product_id"]), "Button 5", *REPORTS),
    "evdev": Kind(partial(event_pad, XBOX), XBOX, "Button 7", *EVENTS),
}

LINK = "gimbal=socketcan:vcan0"
FAST = 120.0  # deg/s, the pan's
RAMP = 25.0, 70.0  # deg from full speed to rest: 30 by its acceleration, more by its jerk and until it is noticed


def profile(kind: Kind) -> str:
    vendor, product = kind.ids
    return f"""
name: A pad in the hand
links: {{gimbal: "sim:"}}
axes:
  pan: {{min: null, max: null, velocity: {FAST}, acceleration: 240, jerk: 1200}}
inputs:
  - device: {{vendor: {vendor}, product: {product}}}
    name: {NAME}
    enable: {kind.enable}
    controls: {{X: {{axis: pan}}}}
sticks: {{ranges: [1.0]}}
sinks:
  - {{type: gimbal, link: gimbal, mode: position, rate: 50}}
"""


class Scene:
    """A pad and a run that it drives, watched from the bus."""

    def __init__(self, kind: Kind, pad: Any, live: subprocess.Popen[str], bus: BusListener) -> None:
        self.kind, self.pad, self.bus = kind, pad, bus
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
        self.pad.show(self.kind.enabled)
        self.bus.more(10)
        begin = self.bus.pan
        self.pad.show(self.kind.right)
        self.bus.until(lambda: turned(begin, self.bus.pan) > 60, "a pan by 60 degrees")

    def still(self) -> bool:
        """Whether the gimbal stays where it is, over ten of its answers."""
        return len({angle.pan for angle in self.bus.more(10)}) == 1


def turned(begin: float, end: float) -> float:
    """Degrees to the right, of less than half a turn either way."""
    return (end - begin + 180) % 360 - 180


@pytest.fixture(params=KINDS)
def scene(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Scene]:
    kind = KINDS[request.param]
    (tmp_path / "rig.yaml").write_text(profile(kind))
    options = "--rig", str(tmp_path / "rig.yaml"), "--presets", str(tmp_path / "presets.yaml"), "--link", LINK
    with ExitStack() as stack:
        stack.enter_context(own_network("link add dev vcan0 type vcan", "link set vcan0 up"))
        pad = stack.enter_context(kind.plugged_in(kind.resting))
        sim = stack.enter_context(running("sim", "--link", LINK))
        assert sim.stdout is not None
        assert "simulated gimbal" in sim.stdout.readline()
        bus = stack.enter_context(BusListener("vcan0"))
        scene = Scene(kind, pad, stack.enter_context(running("live", *options)), bus)
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

    with scene.kind.plugged_in(scene.kind.right) as again:
        scene.pad = again
        scene.hear(f"{NAME}: center its sticks")
        assert scene.still(), "a stick that was never seen centred moved the pan"
        again.show(scene.kind.resting)
        scene.bus.more(10)
        again.show(scene.kind.right_alone)
        assert scene.still(), "a pad that was not enabled again moved the pan"
        again.show(scene.kind.resting)
        scene.drive()
        again.show(scene.kind.resting)
        scene.bus.until(scene.still, "rest")
