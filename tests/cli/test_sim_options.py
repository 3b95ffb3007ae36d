"""The options of `teleop sim` become a device, or are refused by their names."""

from __future__ import annotations

from dataclasses import replace

import pytest

from teleop.cli.sim_options import DRONE_DEFAULTS, GIMBAL_DEFAULTS, GimbalSim, _signs
from teleop.core.errors import UsageError
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.gimbal.device import SimulatedGimbal


def test_without_options_there_are_devices_as_documented():
    assert isinstance(GIMBAL_DEFAULTS.made(), SimulatedGimbal)
    assert isinstance(DRONE_DEFAULTS.made(0.0), SimulatedDrone)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"push_rate": 0}, r"--push-rate must be above 0 and at most 100 Hz, not 0"),
        ({"push_rate": 100.5}, r"--push-rate .* not 100\.5"),
        ({"reaction": 60}, r"--reaction must be 0\.\.60 s, not 60"),
        ({"reaction": float("nan")}, r"--reaction"),
        ({"roll_error": -30.1}, r"--roll-error must be -30\.\.30 deg"),
        ({"pitch_max": 180}, r"--pitch-max must be 1\.\.179 deg, not 180"),
        ({"speed_signs": "yaw=2"}, r"--speed-signs yaw=2: write yaw, roll or pitch"),
        ({"report_signs": "pan=-1"}, r"--report-signs pan=-1"),
        ({"signs": "yaw=-2"}, r"--signs yaw=-2: write yaw, roll or pitch"),
        ({"bus_errors": 1.1}, r"--bus-errors must be 0\.\.1, not 1\.1"),
        ({"bus_errors": float("nan")}, r"--bus-errors must be 0\.\.1"),
        ({"refuses": "position,focus"}, r"--refuses position,focus: write position, speed, stick, mode, not focus"),
    ],
)
def test_a_gimbal_that_cannot_be_is_refused_by_the_option_s_name(options: dict, error: str):
    with pytest.raises(UsageError, match=error):
        GimbalSim(**options).made()


@pytest.mark.parametrize("name", ["answer_delay", "virtual_rc_timeout", "movement_timeout"])
@pytest.mark.parametrize("seconds", [-0.1, 60.0])
def test_a_time_of_the_drone_is_0_to_60_s(name: str, seconds: float):
    with pytest.raises(UsageError, match=f"--{name.replace('_', '-')} must be"):
        replace(DRONE_DEFAULTS, **{name: seconds}).made(0.0)
    replace(DRONE_DEFAULTS, **{name: 59.0}).made(0.0)


@pytest.mark.parametrize(
    ("text", "signs"),
    [("", (1, 1, 1)), ("yaw=-1", (-1, 1, 1)), (" pitch = -1 , roll=+1,", (1, 1, -1)), ("roll=-1,yaw=-1", (-1, -1, 1))],
)
def test_signs_are_those_of_yaw_roll_and_pitch(text: str, signs: tuple[int, int, int]):
    assert _signs("--speed-signs", text) == signs
