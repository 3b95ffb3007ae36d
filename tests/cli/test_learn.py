"""`teleop live --learn` on a terminal, with a recorded pad in a hand that moves its stick again and again."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from command import teleop
from terminal import Terminal, terminal
from terminal_screen import screen

from teleop.config.profile import load_profile
from teleop.config.resources import folder

RECORDINGS = Path(__file__).parents[1] / "data" / "hid-recordings"
SIM = (folder("profiles") / "sim.yaml").read_text()
REST, RIGHT = "7f7f7f7f08000000", "ff7f7f7f08000000"
LONG = 120.0  # s: longer than any machine takes


def recorded(file: Path, unplugged: float = LONG) -> Path:
    """An F310 whose stick goes right again and again; a slow machine answers with the next one."""
    rows = [{"time": 0, "report": REST}]
    begin = 3.0
    while begin + 1.3 < unplugged:
        rows += [{"time": begin, "report": RIGHT}, {"time": begin + 0.4, "report": REST}]
        begin += 1.3
    end = [{"time": unplugged, "unplugged": True}]
    first = (RECORDINGS / "steady-at-the-stop.jsonl").read_text().splitlines()[0]
    file.write_text(first + "\n" + "".join(json.dumps(row) + "\n" for row in [*rows, *end]))
    return file


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    file = tmp_path / "mine.yaml"
    file.write_text(SIM)
    return file


def test_the_whole_dialogue_on_a_terminal_of_80_columns(tmp_path: Path, rig: Path) -> None:
    pad = recorded(tmp_path / "pad.jsonl")
    arguments = ("live", "--learn", "--rig", rig.name, "--input-recording", pad.name)
    with screen(*arguments, folder=tmp_path, cwd=tmp_path) as term:
        term.look(term.wait_for("Move the control for PAN RIGHT; Enter skips"), "q leaves without writing")
        term.wait_for("X: release it")
        term.look(term.wait_for("Move the control for TILT UP"))
        term.type("\r")
        term.wait_for("Move the control for ROLL CLOCKWISE")
        term.type("t")
        term.look(term.wait_for("Try every control. Nothing moves."), "q leaves without writing")
        term.look(term.wait_for("pan +1.00"))
        assert rig.read_text() == SIM
        term.type("\r")
        assert term.end() == 0
        term.look()
        assert "its inputs are what was learned" in term.text
    assert rig.read_text().startswith(SIM)
    assert load_profile(str(rig)).inputs[0].controls.keys() == {"X"}


def interrupt(term: Terminal) -> None:
    term.type("\x03")


def terminate(term: Terminal) -> None:
    term.process.send_signal(signal.SIGTERM)


@pytest.mark.parametrize("end", [interrupt, terminate, Terminal.hang_up])
def test_however_it_ends_the_file_is_as_it_was_and_so_is_the_terminal(
    end: Callable[[Terminal], None], tmp_path: Path, rig: Path
) -> None:
    pad = recorded(tmp_path / "pad.jsonl")
    with terminal("live", "--learn", "--rig", str(rig), "--input-recording", str(pad), folder=tmp_path) as term:
        term.wait_for("X: release it")
        end(term)
        assert term.end() == (130, "")
        if term.slave >= 0:
            assert term.restored
            assert "nothing was written" in term.shown
    assert rig.read_text() == SIM
    assert [file.name for file in tmp_path.iterdir() if file.suffix != ".jsonl"] == ["mine.yaml"]


def test_an_unplugged_device_ends_it(tmp_path: Path, rig: Path) -> None:
    pad = recorded(tmp_path / "pad.jsonl", unplugged=1)
    with terminal("live", "--learn", "--rig", str(rig), "--input-recording", str(pad), folder=tmp_path) as term:
        code, _ = term.end()
        assert code == 1
        assert term.restored
        assert "Logitech F310: unplugged; nothing was written" in term.shown
    assert rig.read_text() == SIM


def test_a_shipped_rig_and_no_file_print_the_inputs_for_a_pipe(tmp_path: Path) -> None:
    pad = recorded(tmp_path / "pad.jsonl")
    with terminal("live", "--learn", "--input-recording", str(pad), folder=tmp_path) as term:
        term.wait_for("X: learned")
        term.type("t")
        term.wait_for("prints the inputs")
        term.type("\r")
        code, out = term.end()
    assert code == 0
    assert out.endswith("# Logitech F310\n    controls:\n      X: {axis: pan}\n")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--learn"], "teleop: --learn asks questions: run it on a terminal"),
        (["-o", "mine.yaml"], "teleop: -o: needs --learn"),
        (["--learn", "--fast"], "teleop: --fast: not together with --learn, which moves nothing and asks in real time"),
    ],
)
def test_what_it_needs_is_said_in_one_line(arguments: list[str], line: str) -> None:
    done = teleop("live", *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"{line}\n"
