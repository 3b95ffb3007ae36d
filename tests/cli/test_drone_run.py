"""A simulated drone by the command line: nobody flies unasked, and one sequence moves sticks, gimbal and focus."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command import running, teleop
from terminal import terminal

from teleop.app.drone_flight import HOVER
from teleop.core.axes import Axis
from teleop.recording.messages import Messages
from teleop.recording.reader import read_take
from teleop.sim.drone.telemetry import EARTH

SEQUENCE = """
title: Rise and reveal
keyframes:
  - {at: 0,  stick_throttle: 0, stick_pitch: 0, pan: 0, focus: 0.2}
  - {at: 2s, stick_throttle: 0.6}
  - {at: 4s, stick_throttle: 0, stick_pitch: 0.4, pan: 40, focus: 0.8}
  - {at: 8s, stick_pitch: 0, pan: 90}
"""
STICKS = "time,stick_pitch\n0,0\n1,0.5\n6,0\n7,0\n"
RIG = "--rig", "sim-drone"


def said_by_drone(take: Path) -> Iterator[tuple[float, dict[str, Any]]]:
    """What a take has of it, with the times."""
    for line in Messages(take):
        if line.topic == "/drone":
            yield line.time, json.loads(line.data)


@pytest.fixture
def sequence(tmp_path: Path) -> str:
    (tmp_path / "rise.yaml").write_text(SEQUENCE)
    return str(tmp_path / "rise.yaml")


@pytest.fixture
def sticks(tmp_path: Path) -> str:
    (tmp_path / "sticks.csv").write_text(STICKS)
    return str(tmp_path / "sticks.csv")


def test_a_script_flies_only_when_somebody_said_so(sequence: str, sticks: str) -> None:
    for arguments in (["play", sequence], ["live", "--sticks", sticks]):
        ran = teleop(*arguments, *RIG, "--fast")
        assert ran.returncode == 2
        assert "flies a drone: run it on a terminal to confirm, or give --i-understand" in ran.stderr


def test_one_sequence_moves_sticks_gimbal_and_focus_on_one_clock(sequence: str, tmp_path: Path) -> None:
    take = tmp_path / "take.mcap"
    ran = teleop("play", sequence, *RIG, "--fast", "--i-understand", "--json", "--take", str(take))
    assert ran.returncode == 0, ran.stderr
    assert "drone: engaged: the drone confirms virtual RC" in ran.stderr
    assert "virtual RC is released: the drone confirms it" in ran.stderr
    report = json.loads(ran.stdout)
    drone = report["drone"]
    assert drone["height"] > 12, "it was raised"
    assert drone["latitude"] > 52.5, "and flown north"
    assert (drone["stage"], drone["status"], drone["virtual_rc"]) == ("idle", "in air", False)
    assert set(report["axes"]) == {"pan", "focus"}, "nobody measures a stick"
    motion = read_take(take).motion
    assert motion[Axis.STICK_THROTTLE][0].max() == pytest.approx(0.6, abs=0.01)
    assert motion[Axis.PAN][0][-1] == pytest.approx(90)


def test_the_shipped_fly_by_keeps_looking_at_what_it_passes(tmp_path: Path) -> None:
    """Its header says where that is; how far it has flown is what the simulated drone says of itself."""
    take = tmp_path / "take.mcap"
    ran = teleop("play", "fly-by", *RIG, "--fast", "--i-understand", "--take", str(take))
    assert ran.returncode == 0, ran.stderr
    motion = read_take(take)
    ahead = above = 0.0
    for time, state in said_by_drone(take):
        ahead, above = math.radians(state["latitude"] - 52.5) * EARTH, state["height"] - HOVER
        if ahead > 0.1:  # the rig is in place; pan goes by at 17 deg/s, and a tenth of a second is how old a place is
            pan, tilt = (np.interp(time, motion.times, motion.motion[axis][0]) for axis in (Axis.PAN, Axis.TILT))
            assert pan == pytest.approx(math.degrees(math.atan2(10, 15 - ahead)), abs=3)
            assert tilt == pytest.approx(-math.degrees(math.atan2(4 + above, math.hypot(10, 15 - ahead))), abs=1)
    assert ahead == pytest.approx(30, abs=0.5)
    assert above == pytest.approx(2, abs=0.3)


def test_a_take_has_what_the_drone_said(sequence: str, tmp_path: Path) -> None:
    take = tmp_path / "take.mcap"
    assert teleop("play", sequence, *RIG, "--fast", "--i-understand", "--take", str(take)).returncode == 0
    said = [state for _, state in said_by_drone(take)]
    stages = [state["stage"] for state in said]
    assert list(dict.fromkeys(stages)) == ["taking", "engaged", "leaving"] or stages[0] == "idle"
    assert 60 < len(said) < 200, "ten times a second"
    assert max(state["height"] for state in said) > 12
    assert {"attitude", "velocity", "battery", "rc", "rc_mode", "gimbal", "device", "virtual_rc"} <= said[0].keys()


def test_a_take_of_a_flight_can_be_flown_again(sequence: str, tmp_path: Path) -> None:
    take = tmp_path / "take.mcap"
    assert teleop("play", sequence, *RIG, "--fast", "--i-understand", "--take", str(take)).returncode == 0
    again = teleop("play", str(take), *RIG, "--fast", "--i-understand", "--json")
    assert again.returncode == 0, again.stderr
    assert json.loads(again.stdout)["drone"]["height"] > 12


def test_a_flight_keeps_its_time(sequence: str) -> None:
    ran = teleop("play", sequence, *RIG, "--fast", "--i-understand", "--speed", "50%")
    assert ran.returncode == 2
    assert ran.stderr == "--speed 50%: a drone's move has one speed: leave out --speed\n"


def test_recorded_sticks_fly_it_and_its_end_gives_it_back(sticks: str) -> None:
    ran = teleop("live", "--sticks", sticks, *RIG, "--fast", "--i-understand", "--json")
    assert ran.returncode == 0, ran.stderr
    assert "no hand" not in ran.stderr
    assert json.loads(ran.stdout)["drone"]["latitude"] > 52.5 + 1e-4, "15 m"


FLIGHT = """
name: Flight
links: {drone: 'sim:'}
axes:
  stick_roll:     {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
  stick_pitch:    {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
  stick_throttle: {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
  stick_yaw:      {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
sinks: [{type: flight, link: drone, mode: velocity-body, full_scale: {horizontal: 5, vertical: 2, yaw: 60}}]
"""


def test_a_held_stick_is_sent_fifty_times_a_second_and_a_climb_is_positive(tmp_path: Path) -> None:
    (tmp_path / "rig.yaml").write_text(FLIGHT)
    (tmp_path / "s.csv").write_text("time,stick_throttle\n0,0\n1,0.25\n7,0\n8,0\n")
    take = tmp_path / "take.mcap"
    flown = ["live", "--sticks", str(tmp_path / "s.csv"), "--rig", str(tmp_path / "rig.yaml"), "--fast"]
    ran = teleop(*flown, "--i-understand", "--json", "--take", str(take))
    assert ran.returncode == 0, ran.stderr
    report = json.loads(ran.stdout)
    assert report["links"]["drone"]["frames_out"] > 50 * 7.5
    assert report["drone"]["height"] > HOVER + 2
    climbs = [state["velocity"][2] for time, state in said_by_drone(take) if state["velocity"] and 4 < time < 6]
    assert climbs
    assert all(climb == pytest.approx(0.5, abs=0.01) for climb in climbs)


def test_the_word_is_asked_for_on_a_terminal(sequence: str, tmp_path: Path) -> None:
    with terminal("play", sequence, *RIG, folder=tmp_path) as term:
        term.wait_for("Type fly and Enter")
        term.type("no\n")
        code, _ = term.end()
        assert code == 2
        assert "fly was not typed; nothing was sent to the drone" in term.shown


def test_an_operator_types_a_word_and_sees_the_drone(tmp_path: Path) -> None:
    (tmp_path / "long.csv").write_text("time,stick_pitch\n0,0\n60,0\n61,0\n")
    with terminal("live", "--sticks", str(tmp_path / "long.csv"), *RIG, folder=tmp_path) as term:
        term.wait_for("not engaged: d engage Enter")
        term.type("dengage")
        term.wait_for("drone command: engage_")
        term.wait_for("battery 100 %")
        term.type("\r")
        term.wait_for("ENGAGED")
        term.wait_for("virtual RC on")
        term.type("darm\r")
        term.wait_for("arm: sticks in the corners for 2 s")
        term.type("b")
        term.wait_for("virtual RC is released: the drone confirms it")
        term.type("q")
        assert term.end()[0] == 0


def test_offsets_are_for_sequences(tmp_path: Path) -> None:
    axes = "".join(
        f"  {axis}: {{min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}}\n" for axis in Axis if "stick" in axis
    )
    sink = "{type: flight, link: drone, mode: offset-body, full_scale: {horizontal: 5, vertical: 1, yaw: 30}}"
    (tmp_path / "rig.yaml").write_text(f"name: O\nlinks: {{drone: 'sim:'}}\naxes:\n{axes}sinks: [{sink}]\n")
    ran = teleop("live", "--rig", str(tmp_path / "rig.yaml"))
    assert ran.returncode == 2
    assert "mode: offset-body is for sequences" in ran.stderr


def test_a_drone_on_a_real_line_wants_an_app_id(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    with running("sim", "--drone") as far:
        assert far.stdout is not None
        line = far.stdout.readline()
        assert line.startswith("simulated drone on serial:")
        (tmp_path / "s.csv").write_text("time,stick_pitch\n0,0\n1,0\n")
        arguments = ["live", "--sticks", str(tmp_path / "s.csv"), "--i-understand", "--rig", "m100"]
        links = ["--link", f"drone={line.split()[-1]}", "--link", "gimbal=sim:"]
        ran = teleop(*arguments, *links)
        assert ran.returncode == 2
        assert "the drone needs the app id that DJI gave you: in TELEOP_DJI_APP_ID" in ran.stderr
        monkeypatch.setenv("TELEOP_DJI_APP_ID", "123456")
        ran = teleop(*arguments, *links)
        assert ran.returncode == 0, ran.stderr
        assert "123456" not in ran.stdout + ran.stderr
