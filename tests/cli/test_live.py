"""`teleop live` in a real process on a real terminal: keys in, a screen out, and a terminal that is given back."""

from __future__ import annotations

import json
import re
import signal
from pathlib import Path

import pytest
import yaml
from command import teleop
from terminal import terminal
from waiting import wait_until

from teleop.config.resources import folder
from teleop.core.axes import Axis
from teleop.recording.reader import read_take

AT_10 = re.compile(r"\+10\.00 +\+10\.00")  # commanded, and measured in tenths
MOVING = re.compile(r"\+\d+\.(?!00)\d\d")  # an angle that is not 0
LEFT_THE_SCREEN = "\x1b[?1049l"


def test_a_session_by_keys_from_jog_to_stop_to_quit(tmp_path: Path) -> None:
    with terminal("live", "--presets", str(tmp_path / "presets.yaml"), folder=tmp_path) as term:
        term.wait_for("keys  ready")
        term.wait_for("joystick: not plugged in")
        term.type("\x1b[C\x1b[1;2A")
        term.wait_for("+1.00")
        wait_until(lambda: AT_10.search(term.shown), "tilt commanded and measured at 10")
        term.type("s4")
        term.wait_for("preset 4 stored")
        term.type("z ")
        term.wait_for("STOP by keys")
        term.type("4")
        term.wait_for("preset 4 refused: STOP is not cleared")
        term.type("dengage\r")
        term.wait_for("drone: not engaged: STOP is not cleared")
        term.type("cdengage\r")
        term.wait_for("drone engage: this rig has no drone")
        term.type("4")
        term.wait_for("preset 4 ")
        term.type("rq")
        code, out = term.end()
        assert code == 0, term.shown
        assert "Commanded against measured" in out
        assert term.restored
        assert LEFT_THE_SCREEN in term.raw
    stored = yaml.safe_load((tmp_path / "presets.yaml").read_text())["presets"]
    # as exact as the screen shows it: the last thousandths of a step take some ticks
    assert stored == {4: {"pan": 1.0, "tilt": pytest.approx(10, abs=0.005), "roll": 0.0, "focus": 0.0}}


def test_a_target_is_marked_by_looking_at_it(tmp_path: Path) -> None:
    with terminal("live", "--targets", str(tmp_path / "move.yaml"), folder=tmp_path) as term:
        term.wait_for("keys  ready")
        term.type("\x1b[1;2C")
        wait_until(lambda: AT_10.search(term.shown), "pan commanded and measured at 10")
        term.type("tdoor,4")
        term.wait_for("mark target: door,4_")
        term.type("\r")
        term.wait_for("target door: 0.695, 3.939, 0 m")
        term.type("q")
        assert term.end()[0] == 0, term.shown
    assert yaml.safe_load((tmp_path / "move.yaml").read_text()) == {"targets": {"door": [0.695, 3.939, 0.0]}}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_in_mid_pan_gives_the_terminal_back(tmp_path: Path, number: signal.Signals) -> None:
    rig = tmp_path / "slow.yaml"  # on its way for many seconds, however seldom the screen is drawn
    rig.write_text((folder("profiles") / "sim.yaml").read_text().replace("velocity: 120", "velocity: 1"))
    with terminal("live", "--rig", str(rig), folder=tmp_path) as term:
        term.wait_for("keys  ready")
        term.type("L")
        wait_until(lambda: MOVING.search(term.shown), "a pan on the screen")
        term.process.send_signal(number)
        code, _ = term.end()
        assert code == 130
        assert term.restored
        assert f"stopped: {number.name} received" in term.raw.partition(LEFT_THE_SCREEN)[2]


def test_ctrl_c_and_ctrl_z_as_typed(tmp_path: Path) -> None:
    with terminal("live", folder=tmp_path) as term:
        term.wait_for("keys  ready")
        term.type("\x1a\x13")  # neither suspends the program nor holds the screen
        term.type("\x1b[C")
        term.wait_for("+1.00")
        term.type("\x03")
        assert term.end()[0] == 130
        assert term.restored


def test_a_window_that_is_closed_in_mid_pan_is_a_stop_that_comes_to_rest(tmp_path: Path) -> None:
    take, rig = tmp_path / "take.mcap", tmp_path / "slow.yaml"
    rig.write_text((folder("profiles") / "sim.yaml").read_text().replace("velocity: 120", "velocity: 10"))
    with terminal("live", "--json", "--rig", str(rig), "--take", str(take), folder=tmp_path) as term:
        term.wait_for_keys()
        term.type("+L")
        wait_until(lambda: take.exists() and take.stat().st_size > 6000, "a second of the pan in the take")
        term.hang_up()
        code, out = term.end()
    report = json.loads(out)
    assert code in (1, 130)
    assert report["result"] in ("failed", "interrupted")
    assert set(report["reasons"]) <= {"the terminal was closed", "SIGHUP received"}
    assert report["reasons"]
    recorded = read_take(take)
    assert recorded.ending is not None
    end = recorded.state(Axis.PAN, -1)
    assert 0.5 < end.position < 89
    assert (end.velocity, end.acceleration) == (0, 0)


def test_json_stays_one_object_and_the_terminal_stays_quiet(tmp_path: Path) -> None:
    with terminal("live", "--json", folder=tmp_path) as term:
        term.wait_for_keys()
        term.type("q")
        code, out = term.end()
        assert (code, term.shown) == (0, "")
        assert json.loads(out)["result"] == "done"
        assert out.count("\n") == 1


def test_recorded_sticks_on_a_terminal_end_by_themselves_and_keys_can_stop_them(tmp_path: Path) -> None:
    (tmp_path / "sticks.csv").write_text("time,pan\n0,0.3\n1,0\n1.5,0\n")
    with terminal("live", "--sticks", str(tmp_path / "sticks.csv"), folder=tmp_path) as term:
        term.wait_for("sticks.csv")
        code, _ = term.end()
        assert code == 0
        assert term.restored
    (tmp_path / "sticks.csv").write_text("time,pan\n0,0.1\n60,0\n")
    with terminal("live", "--sticks", str(tmp_path / "sticks.csv"), folder=tmp_path) as term:
        term.wait_for("keys  ready")
        term.type(" ")
        term.wait_for("STOP by keys")
        term.type("q")
        assert term.end()[0] == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["live"], "no joystick and no terminal: plug in a joystick"),
        (["live", "--fast"], "--fast: needs --sticks or --input-recording: an operator's inputs are in real time"),
        (["live", "--learn"], "--learn asks questions: run it on a terminal"),
    ],
)
def test_what_cannot_be_done_without_hands_is_said_in_one_line(arguments: list[str], said: str) -> None:
    done = teleop(*arguments)
    assert done.returncode == 2, done.stderr
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_bad_presets_file_is_refused_before_anything_opens(tmp_path: Path) -> None:
    (tmp_path / "presets.yaml").write_text("presets:\n  1: {pna: 3}\n")
    with terminal("live", "--presets", str(tmp_path / "presets.yaml"), folder=tmp_path) as term:
        assert term.end()[0] == 2
        assert "presets.yaml:2:7: presets.1: unknown key `pna`; did you mean `pan`?" in term.shown
        assert term.restored


def test_a_burst_of_a_held_key_is_no_sum_and_a_run_that_ends_stopped_says_so(tmp_path: Path) -> None:
    take, rig = tmp_path / "take.mcap", tmp_path / "slow.yaml"
    rig.write_text((folder("profiles") / "sim.yaml").read_text().replace("velocity: 120", "velocity: 5"))
    with terminal("live", "--json", "--rig", str(rig), "--take", str(take), folder=tmp_path) as term:
        term.wait_for_keys()
        term.type("++" + "\x1b[1;2C" * 15)
        wait_until(lambda: take.exists() and take.stat().st_size > 6000, "a second of it in the take")
        term.type(" q")
        code, out = term.end()
    report = json.loads(out)
    assert (code, report["result"]) == (0, "done")
    assert report["reasons"] == ["ended while stopped: STOP by keys"]
    assert read_take(take).state(Axis.PAN, -1).position <= 10
