"""Pitch and roll that the gimbal's replies exchange are named within a few degrees; hands, lag and noise are none."""

from __future__ import annotations

import math
import random
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.cli import run
from teleop.core.axes import Axis, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.monitors.exchanged_axes import ExchangedAxesGuard
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import Firmware

PROFILE = """
name: Old
links: {gimbal: "sim:"}
axes:
  pan:  {min: -90, max: 90, velocity: 40, acceleration: 120, jerk: 600}
  tilt: {min: -50, max: 60, velocity: 40, acceleration: 120, jerk: 600}
  roll: {min: -30, max: 30, velocity: 30, acceleration: 120, jerk: 600}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50MORE}]
"""
TILT = "keyframes: [{at: 0, tilt: 0}, {at: 3, tilt: 20}]"
BOTH = "keyframes: [{at: 0, tilt: 0, roll: 0}, {at: 3, tilt: -20, roll: 10}]"
EXCHANGED = Firmware(legacy_replies=True, legacy_order="yaw-pitch-roll")
ALWAYS = Firmware(legacy_order="all-yaw-pitch-roll")


def played(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    mode: str,
    move: str,
    more: str = "",
    *,
    held: bool = False,
    **settings: Any,
) -> tuple[int, SimulatedGimbal]:
    """The exit code, and the gimbal as it was left."""
    made: list[SimulatedGimbal] = []

    def make(**options: Any) -> SimulatedGimbal:
        made.append(SimulatedGimbal(**{**options, **settings}))
        made[-1].hold(0.0, pitch=held)
        return made[-1]

    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", make)
    (folder / "rig.yaml").write_text(PROFILE.replace("MODE", mode).replace("MORE", more))
    (folder / "move.yaml").write_text(move)
    return run(["play", str(folder / "move.yaml"), "--rig", str(folder / "rig.yaml"), "--fast"]), made[-1]


@pytest.mark.parametrize(
    ("mode", "move", "more", "firmware", "line"),
    [
        ("position", TILT, "", EXCHANGED, "legacy_angles: yaw-pitch-roll"),
        ("stick", BOTH, "", EXCHANGED, "legacy_angles: yaw-pitch-roll"),
        ("speed", BOTH, ", signs: {roll: -1}", EXCHANGED, "legacy_angles: yaw-pitch-roll"),
        ("position", TILT, "", ALWAYS, "legacy_angles: all-yaw-pitch-roll"),
        (
            "speed",
            TILT,
            ", legacy_angles: yaw-pitch-roll",
            Firmware(legacy_replies=True),
            "legacy_angles: yaw-roll-pitch",
        ),
    ],
)
def test_it_is_named_with_the_line_that_the_profile_needs_and_that_line_cures_it(
    mode: str,
    move: str,
    more: str,
    firmware: Firmware,
    line: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    code, gimbal = played(tmp_path, monkeypatch, mode, move, more, firmware=firmware)
    error = capsys.readouterr().err
    assert code != 0
    assert "tilt is measured as roll: sent tilt" in error
    assert f"needs {line}\n" in error
    assert max(abs(gimbal.angles.pitch), abs(gimbal.angles.roll)) < 8, "the run ends within a few degrees"
    cured = f"{more.replace(', legacy_angles: yaw-pitch-roll', '')}, {line}"
    code, gimbal = played(tmp_path, monkeypatch, mode, move, cured, firmware=firmware)
    assert code == 0, capsys.readouterr().err


def test_a_first_position_that_sends_tilt_to_the_place_of_roll_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    move = "keyframes: [{at: 0, tilt: 1, roll: -4}, {at: 20, tilt: 1, roll: -4}]"
    settings = {"firmware": EXCHANGED, "boot": (0.0, 1.0, -4.0)}
    code, _ = played(tmp_path, monkeypatch, "position", move, **settings)
    assert code != 0
    assert "measured as" in capsys.readouterr().err


def watched(*, seed: int, exchanged: bool, lag: float, gain: float, noise: float, held: bool, hand: float = 0.0) -> str:
    """What a guard says of a position-driven pair that follows a swing, or of one that a hand holds or moves."""
    dice, found = random.Random(seed), set[Axis]()
    guard = ExchangedAxesGuard((Axis.TILT, Axis.ROLL), 1, lambda: "the line", 0.0, speeds=False, found=found)
    tilt = roll = 0.0
    for count in range(400):
        now = count / 100
        planned = 4.0 * (1 - math.cos(1.5 * now)), 1.0 * math.sin(now)
        tilt += 0.0 if held else (gain * planned[0] - tilt) * 0.01 / lag
        roll += (gain * planned[1] - roll) * 0.01 / lag + hand * math.sin(0.9 * now) * 0.01
        if count % 4:
            continue
        pair = [round(angle + dice.gauss(0, noise), 1) for angle in (tilt, roll)]
        pair = pair[::-1] if exchanged else pair
        reported = {axis: Reading(angle, now) for axis, angle in zip((Axis.TILT, Axis.ROLL), pair, strict=True)}
        motion = {axis: State(angle, 0.0) for axis, angle in zip((Axis.TILT, Axis.ROLL), planned, strict=True)}
        try:
            guard.observe(Tick(now, motion, {}, (), reported))
        except DeviceError as error:
            assert found == {Axis.TILT, Axis.ROLL}
            return str(error)
    return ""


plants = st.fixed_dictionaries(
    {
        "seed": st.integers(0, 1000),
        "lag": st.floats(0.02, 0.2),
        "gain": st.floats(0.85, 1.1),
        "noise": st.floats(0.0, 0.1),
    }
)


@settings(max_examples=15)
@given(plants, st.booleans(), st.floats(-15, 15))
def test_no_hand_and_no_slow_gimbal_is_taken_for_it(plant: dict[str, Any], held: bool, hand: float) -> None:
    assert watched(exchanged=False, held=held, hand=hand, **plant) == ""


@settings(max_examples=15)
@given(plants)
def test_lag_gain_and_noise_do_not_hide_it(plant: dict[str, Any]) -> None:
    assert watched(exchanged=True, held=False, **plant).startswith("tilt is measured as roll")


def test_an_axis_held_by_hand_on_the_wire_is_not_called_exchanged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    slow = Dynamics(lag=0.1, drift=0.5)
    code, _ = played(tmp_path, monkeypatch, "speed", BOTH, held=True, dynamics=slow)
    assert code != 0
    assert "measured as" not in capsys.readouterr().err
