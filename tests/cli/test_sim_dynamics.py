"""The options of `teleop sim` for the motion of its gimbals, and the same keys in a profile."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from teleop.cli import run
from teleop.cli.sim_dynamics import DynamicsSim
from teleop.cli.sim_options import GIMBAL_DEFAULTS
from teleop.config.documents.document import DocumentError
from teleop.config.profile import load_profile
from teleop.config.simulated_section import RANGES, SimulatedSection
from teleop.core.errors import UsageError
from teleop.devices.gimbal.profile_simulation import simulated_settings
from teleop.sim.gimbal.dynamics import Dynamics

PROFILE = """
name: Slow
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, simulated: {SIMULATED}}]
"""


def written(folder: Path, simulated: str) -> str:
    path = folder / "rig.yaml"
    path.write_text(PROFILE.replace("SIMULATED", simulated))
    return str(path)


def test_options_are_for_all_axes_or_for_some() -> None:
    settings = DynamicsSim(lag="0.1", gain="yaw=0.9, pitch=1.1", natural_frequency="2.5").settings({})
    yaw, roll, pitch = settings["dynamics"]
    assert yaw == Dynamics(lag=0.1, gain=0.9, natural_frequency=2.5)
    assert roll == Dynamics(lag=0.1, natural_frequency=2.5)
    assert pitch == Dynamics(lag=0.1, gain=1.1, natural_frequency=2.5)
    assert GIMBAL_DEFAULTS.made(settings)


def test_without_options_nothing_differs_from_the_profile(tmp_path: Path) -> None:
    assert DynamicsSim().settings({})["dynamics"] == [Dynamics()] * 3
    profile = load_profile(written(tmp_path, "lag: {pan: 0.2}, drift: 0.5, mount: 180, lost_readings: 0.1"))
    settings = DynamicsSim(drift="roll=1").settings(simulated_settings(profile, "gimbal"))
    assert settings["dynamics"] == [Dynamics(lag=0.2, drift=0.5), Dynamics(drift=1.0), Dynamics(drift=0.5)]
    assert (settings["mount"], settings["lost_readings"]) == (180.0, 0.1)
    assert DynamicsSim(mount=90.0).settings(settings)["mount"] == 90.0


def test_the_profile_and_the_simulator_have_the_same_keys_and_defaults() -> None:
    assert Dynamics(**SimulatedSection().of("pan")) == Dynamics()
    assert set(RANGES) == set(Dynamics.__dataclass_fields__)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"lag": "2.1"}, r"--lag must be 0\.\.2 s, not 2\.1"),
        ({"dead_time": "-0.1"}, r"--dead-time must be 0\.\.1 s, not -0\.1"),
        ({"gain": "0"}, r"--gain must be 0\.1\.\.3, not 0"),
        ({"drift": "yaw=11"}, r"--drift must be -10\.\.10 deg/s, not 11"),
        ({"damping": "1"}, r"--damping must be 0\.01\.\.0\.99, not 1"),
        ({"lag": "nan"}, r"--lag must be a number"),
        ({"lag": "slow"}, r"--lag slow: write a number, or yaw=NUMBER,pitch=NUMBER"),
        ({"lag": "pan=0.1"}, r"--lag pan=0\.1: write yaw, roll or pitch"),
        ({"mount": 181.0}, r"--mount must be -180\.\.180 deg, not 181"),
        ({"lost_readings": 1.5}, r"--lost-readings must be 0\.\.1, not 1\.5"),
    ],
)
def test_an_option_that_no_gimbal_has_is_refused(options: dict[str, Any], error: str) -> None:
    with pytest.raises(UsageError, match=error):
        DynamicsSim(**options).settings({})


@pytest.mark.parametrize(
    ("simulated", "error"),
    [
        ("lag: 5", "lag must be 0..2 s, not 5"),
        ("lag: {pan: 5}", "lag: pan must be 0..2 s, not 5"),
        ("lag: {yaw: 0.1}", "lag: it has no axis 'yaw'; a gimbal has pan, tilt, roll"),
        ("lag: {pan: fast}", "lag: pan must be a number, not 'fast'"),
        ("lag: {pan: '0,1'}", "lag: pan: 0,1: write 0.1"),
        ("gain: high", "gain must be a number, not 'high'"),
        ("dead_time: true", "dead_time must be a number, not true"),
        ("mount: 200", "mount must be at most 180"),
        ("lost_readings: -1", "lost_readings must be at least 0"),
        ("speed: 3", "unknown key `speed`"),
    ],
)
def test_a_profile_is_checked_too(simulated: str, error: str, tmp_path: Path) -> None:
    with pytest.raises(DocumentError) as caught:
        load_profile(written(tmp_path, simulated))
    [problem] = caught.value.problems
    assert error in problem


def test_a_rehearsal_runs_with_the_profiles_dynamics(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rig = written(tmp_path, "lag: 0.08, dead_time: 0.02, gain: 0.95, backlash: 0.05, report_age: 0.02")
    assert run(["play", "nudge", "--rig", rig, "--fast"]) == 0, capsys.readouterr().err
