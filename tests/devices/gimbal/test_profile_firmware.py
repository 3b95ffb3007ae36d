"""A simulated gimbal counts as the profile says that the real one does, so a rehearsal runs through."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.cli import run
from teleop.config.profile import load_profile
from teleop.devices.gimbal.profile_firmware import profile_firmware
from teleop.sim.gimbal.firmware import DOCUMENTED

PROFILE = """
name: Other signs
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50, SIGNS}]
"""


def written(folder: Path, mode: str, signs: str) -> str:
    path = folder / "rig.yaml"
    path.write_text(PROFILE.replace("MODE", mode).replace("SIGNS", signs))
    return str(path)


@pytest.mark.parametrize("mode", ["position", "speed", "stick"])
@pytest.mark.parametrize(
    "signs",
    [
        "speed_signs: {pan: -1, tilt: -1}",
        "report_signs: {pan: -1}",
        "signs: {pan: -1}, speed_signs: {pan: 1}",
        "speed_signs: {pan: -1}, report_signs: {tilt: -1}, mapping: {yaw: tilt, pitch: pan}",
    ],
)
def test_a_rehearsal_does_not_trip_the_direction_guard(
    mode: str, signs: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = run(["play", "nudge", "--rig", written(tmp_path, mode, signs), "--fast"])
    assert code == 0, capsys.readouterr().err


@pytest.mark.parametrize(
    ("signs", "speeds", "reports"),
    [
        ("speed_signs: {tilt: -1}", (1, 1, -1), (1, 1, 1)),
        ("report_signs: {pan: -1}", (1, 1, 1), (-1, 1, 1)),
        ("signs: {pan: -1}, speed_signs: {pan: 1}", (-1, 1, 1), (1, 1, 1)),
        ("signs: {pan: -1}, speed_signs: {pan: -1}", (1, 1, 1), (1, 1, 1)),
        ("speed_signs: {pan: -1}, mapping: {roll: pan, pitch: tilt}", (1, -1, 1), (1, 1, 1)),
    ],
)
def test_signs_are_in_the_order_of_yaw_roll_and_pitch_and_relative_to_positions(
    signs: str, speeds: tuple[int, int, int], reports: tuple[int, int, int], tmp_path: Path
) -> None:
    made = profile_firmware(load_profile(written(tmp_path, "speed", signs)), "gimbal")
    assert (made.speed_signs, made.report_signs) == (speeds, reports)


def test_a_profile_without_such_signs_simulates_the_documented_firmware(tmp_path: Path) -> None:
    profile = load_profile(written(tmp_path, "speed", "signs: {pan: -1}"))
    assert profile_firmware(profile, "gimbal") is DOCUMENTED
