"""A distant stick: it moves the rig, and the rig stops by its own clock when it is not heard."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_bench import RigProcess
from hands import FakeInput
from terminal_screen import screen

from teleop.core.axes import Axis
from teleop.core.errors import TeleopError
from teleop.core.operator_input import Command
from teleop.studio.fleet import Fleet
from teleop.studio.sticks import RigSticks


def turn(fleet: Fleet, sticks: RigSticks, until) -> None:
    """Turn the sticks until that holds."""

    def turned() -> bool:
        sticks.turn()
        return until()

    assert fleet.until(turned, 60)


def test_a_stick_moves_a_distant_rig_and_silence_stops_it(tmp_path: Path):
    with RigProcess(tmp_path, "cam-a") as rig, Fleet([rig.endpoint], memory=False) as fleet:
        assert fleet.until(lambda: [each for each in fleet.rigs if each.alive], 60)
        seen = fleet.rig("cam-a")

        def pan() -> float:
            return seen.state["axes"]["pan"]["speed"]

        hand = FakeInput()
        lines: list[str] = []
        with RigSticks(fleet, "cam-a", [hand], lines.append) as sticks:
            turn(fleet, sticks, lambda: seen.state["sticks"]["armed"])
            assert seen.state["holder"] == fleet.name
            hand.deflections = {Axis.PAN: 0.5}
            turn(fleet, sticks, lambda: pan() > 1)
            assert fleet.until(lambda: pan() == 0, 60)  # nothing is sent any more
            assert fleet.until(lambda: not seen.state["sticks"]["armed"], 60)
            for _ in range(20):
                sticks.turn()
            assert pan() == 0
            hand.deflections = {}
            hand.press(Command.ENABLE)  # takes control again
            turn(fleet, sticks, lambda: seen.state["sticks"]["armed"])
            hand.deflections = {Axis.PAN: -0.5}
            turn(fleet, sticks, lambda: pan() < -1)
            hand.press(Command.STOP)
            turn(fleet, sticks, lambda: seen.stopped)
            with Fleet([rig.endpoint], name="bob", memory=False) as other:
                other.wait(30)
                refused = RigSticks(other, "cam-a", [hand], lines.append)
                with pytest.raises(TeleopError, match="has control"):
                    refused.__enter__()
        assert fleet.until(lambda: seen.state["holder"] is None, 60)


def test_the_keys_of_a_terminal_move_a_distant_rig_and_stop_it(tmp_path: Path):
    with RigProcess(tmp_path, "cam-a") as rig, Fleet([rig.endpoint], memory=False) as fleet:
        words = ["fleet", "sticks", "cam-a", "--connect", rig.endpoint]
        with screen(*words, folder=tmp_path, size=(100, 24)) as term:
            term.wait_for("the stick moves it")
            term.type("\x1b[C")  # to the right
            assert fleet.until(lambda: fleet.rig("cam-a").state["axes"]["pan"]["commanded"] > 0.5, 60)
            term.type(" ")
            assert fleet.until(lambda: fleet.rig("cam-a").stopped, 60)
            term.look(term.wait_for("stopped"))
            term.type("q")
            assert term.end() == 0, term.text
            term.look()
        assert fleet.until(lambda: fleet.rig("cam-a").state["holder"] is None, 60)
