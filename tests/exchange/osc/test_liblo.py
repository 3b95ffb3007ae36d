"""OSC as liblo speaks and reads it: `oscsend`, `oscdump`, and a real run with its gateway and a simulated gimbal."""

from __future__ import annotations

import shutil
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from page_bench import until
from real_console import RealConsole

from teleop.config.resources import find

pytestmark = pytest.mark.skipif(not shutil.which("oscsend"), reason="liblo-tools is not installed")


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Studio:
    """A rig, what `oscsend` sends to it, and what `oscdump` prints."""

    def __init__(self, console: RealConsole, port: int, dumped: Path) -> None:
        self.console, self._port, self._dumped = console, port, dumped

    def send(self, address: str, *arguments: str) -> None:
        subprocess.run(["oscsend", "127.0.0.1", str(self._port), address, *arguments], check=True)

    def heard(self, address: str) -> list[str]:
        """The arguments of every message there was to that address, as printed."""
        lines = (line.split(" ", 2)[1:] for line in self._dumped.read_text().splitlines() if line.count(" ") > 1)
        return [rest for head, rest in lines if head == address]

    @property
    def move(self) -> dict[str, Any]:
        return self.console.state["move"] or {}

    def says(self, address: str, end: str) -> bool:
        """Whether the newest message to that address ends so."""
        return bool(found := self.heard(address)) and found[-1].endswith(end)


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    folder = tmp_path_factory.mktemp("studio")
    commands, feedback = free_port(), free_port()
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    entry = f"exchange:\n  - {{type: osc, listen: '127.0.0.1:{commands}', to: '127.0.0.1:{feedback}'}}\n"
    (folder / "rig.yaml").write_text(f"{text}\n{entry}", encoding="utf-8")
    dumped = folder / "dumped"
    with dumped.open("wb") as out:
        dump = subprocess.Popen(["stdbuf", "-oL", "oscdump", str(feedback)], stdout=out)
        try:
            with RealConsole(folder, rig="rig.yaml") as console:
                yield Studio(console, commands, dumped)
        finally:
            dump.terminate()
            dump.wait()


def at(studio: Studio, axis: str) -> float:
    return studio.console.axis(axis)["measured"]


def test_a_goto_goes_there_and_its_position_comes_back(studio: Studio) -> None:
    studio.send("/teleop/goto", "ffff", "12", "5", "0", "0.8")
    until(lambda: abs(at(studio, "pan") - 12) < 0.3 and abs(at(studio, "tilt") - 5) < 0.3)
    until(lambda: studio.says("/teleop/holder", '""'))
    kind, position = studio.heard("/teleop/axis/pan/position")[-1].split()
    assert kind == "f"
    assert float(position) == pytest.approx(12, abs=0.5)
    assert any("OSC 127.0.0.1" in each for each in studio.heard("/teleop/holder"))


def test_a_jog_and_a_preset(studio: Studio) -> None:
    before = studio.console.axis("pan")["commanded"]
    studio.send("/teleop/preset/7/store")
    until(lambda: "7" in studio.console.state["presets"])
    studio.send("/teleop/jog/pan", "ff", "4", "0.3")
    studio.send("/teleop/jog/pan", "ff", "0", "0.3")  # the button is let go
    until(lambda: abs(studio.console.axis("pan")["commanded"] - before - 4) < 1e-3)
    studio.send("/teleop/preset/7", "i", "1")
    until(lambda: abs(studio.console.axis("pan")["commanded"] - before) < 1e-3)


def test_stop_is_obeyed_shown_and_cleared(studio: Studio) -> None:
    studio.send("/teleop/stop")
    until(lambda: studio.says("/teleop/stopped", "i 1"))
    assert studio.console.state["stopped_by"] == "OSC 127.0.0.1"
    studio.send("/teleop/goto", "fff", "0", "0", "0")
    until(lambda: any("STOP is not cleared" in each for each in studio.heard("/teleop/error")))
    studio.send("/teleop/clear", "i", "0")  # a button that is let go
    studio.send("/teleop/clear", "i", "1")
    until(lambda: studio.says("/teleop/stopped", "i 0"))


def test_what_is_out_of_reach_is_refused_and_said(studio: Studio) -> None:
    studio.send("/teleop/goto", "ffff", "900", "0", "0", "1")
    until(lambda: any("outside the soft limits" in each for each in studio.heard("/teleop/error")))


def test_record_and_play(studio: Studio) -> None:
    studio.send("/teleop/record", "i", "1")
    studio.send("/teleop/record", "i", "0")
    until(lambda: studio.says("/teleop/recording", "i 1"))
    studio.send("/teleop/stop_recording")
    until(lambda: studio.says("/teleop/recording", "i 0"))
    studio.send("/teleop/play", "ss", "nudge", "attended")
    until(lambda: studio.move.get("phase") == "paused")  # nobody has been heard for 2 s
    studio.send("/teleop/abort")
    until(lambda: studio.says("/teleop/move", '""') and studio.console.rests and studio.console.state["holder"] is None)
    studio.send("/teleop/play", "s", "nudge")  # as a button does: one message
    until(lambda: studio.move.get("attended") is False)
    until(lambda: studio.says("/teleop/playing", "i 1"))
    studio.send("/teleop/abort")
    until(lambda: studio.says("/teleop/playing", "i 0"))
