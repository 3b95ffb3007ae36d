"""A controller at JACK, a server of its own, and a real run with its gateway and a simulated gimbal."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest
from jack_server import INSTALLED, JackController, jack_server
from page_bench import until
from real_console import RealConsole

from teleop.config.resources import find

pytestmark = pytest.mark.skipif(not INSTALLED, reason="jackd is not installed")

ENTRY = """
exchange:
  - type: midi
    port: desk
    api: jack
    controls:
      - {sends: note 1, press: stop}
      - {sends: note 2, press: clear}
      - {sends: cc 7, position: pan, low: -90, high: 90}
      - {sends: cc 60, jog: tilt, step: 1}
"""


@pytest.fixture(scope="module")
def console(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RealConsole]:
    folder = tmp_path_factory.mktemp("desk")
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    (folder / "rig.yaml").write_text(f"{text}\n{ENTRY}", encoding="utf-8")
    with jack_server(), RealConsole(folder, rig="rig.yaml") as running:
        yield running


def test_a_controller_moves_and_stops_the_rig_and_is_served_again_after_it_was_lost(
    console: RealConsole,
) -> None:
    def held(desk: JackController, condition: Callable[[], object], *messages: tuple[int, int, int]) -> None:
        """Send until it has come true: JACK without real time loses a message now and then."""
        while not condition():
            for message in messages:
                desk.send(*message)
            time.sleep(0.1)

    desk = JackController("desk")
    until(lambda: desk.got)
    held(desk, lambda: console.axis("tilt")["measured"] > 2, (0xB0, 60, 3))
    until(lambda: console.rests and console.state["holder"] is None)
    fader = [(0xB0, 7, value) for value in (63, 64, 74)]
    held(desk, lambda: abs(console.axis("pan")["measured"] - (180 * 74 / 127 - 90)) < 0.3, *fader)
    until(lambda: (0xB0, 7, 74) in desk.got)  # its motor is where the axis is
    held(desk, lambda: console.state["stopped"], (0x90, 1, 100))
    assert console.state["stopped_by"] == "MIDI desk"
    until(lambda: (0x90, 1, 127) in desk.got)
    desk.close()
    until(lambda: any("the port is gone" in each["text"] for each in console.state["messages"]))
    again = JackController("desk")
    until(lambda: (0x90, 1, 127) in again.got)
    held(again, lambda: not console.state["stopped"], (0x90, 2, 100))
    until(lambda: (0x80, 1, 0) in again.got)
    again.close()
