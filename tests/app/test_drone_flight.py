"""The drone of a run: hand-flown positions are refused; what a take records of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from teleop.app.drone_flight import HOVER, Aboard, is_flown, refuse_offsets
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.devices.drone.state import DroneState
from teleop.devices.rig import open_rig

STICKS = [Axis.STICK_ROLL, Axis.STICK_PITCH, Axis.STICK_THROTTLE, Axis.STICK_YAW]


@dataclass
class Status:
    phase: str


def test_a_move_is_flown_where_it_has_a_stick():
    assert is_flown([Axis.PAN, Axis.STICK_YAW])
    assert not is_flown([Axis.PAN, Axis.FOCUS])


def test_a_hand_cannot_hold_a_place_that_a_sequence_can(tmp_path: Path):
    text = (folder("profiles") / "sim-drone.yaml").read_text()
    refuse_offsets(load_profile("sim-drone"))
    flight = "type: flight, link: drone, mode: offset-body, rate: 50, full_scale: {horizontal: 5, vertical: 2, yaw: 60}"
    text = text.replace("type: virtual-rc, link: drone, back_to_rc: true, rate: 20", flight)
    (tmp_path / "rig.yaml").write_text(text)
    with pytest.raises(UsageError, match="offset-body is for sequences: teleop play"):
        refuse_offsets(load_profile(str(tmp_path / "rig.yaml")))


def test_without_a_drone_the_status_of_a_take_is_the_operator_s():
    aboard = Aboard()
    with open_rig(load_profile("sim"), VirtualClock()) as rig:
        aboard.board(rig, [Axis.PAN], lambda _line: None, by_script=True)
        status = Status("playing")
        assert aboard.state() is None
        assert aboard.status(status) is status


@pytest.mark.parametrize("by_script", [True, False])
def test_a_simulated_drone_hovers_for_a_script_and_stands_for_a_pilot(by_script: bool):
    aboard, said = Aboard(), []
    with open_rig(load_profile("sim-drone"), VirtualClock()) as rig:
        aboard.board(rig, STICKS, said.append, by_script=by_script)
        heights = [simulated.autopilot.flight.pose().height for simulated in rig.simulated_drones.values()]
        assert heights == [HOVER if by_script else 0.0]
        assert said == (["the simulated drone hovers at 10 m"] if by_script else [])
        status = aboard.status(Status("playing"))
        assert isinstance(status, dict)
        assert status["phase"] == "playing"
        assert isinstance(status["drone"], DroneState)
