"""`teleop calibrate delay`: on simulated gimbals whose lateness is known, in every mode, and when it cannot be told."""

from __future__ import annotations

import json
import signal
from functools import partial
from itertools import pairwise
from pathlib import Path

import pytest
from command import running, teleop
from fakes import NO_FEEDBACK
from waiting import DEADLINE

from teleop.app.calibration.calibration_move import SHARE, CalibrationMove
from teleop.cli import run
from teleop.config.profile import load_profile
from teleop.core.axes import Axis, Limits, State
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.core.setpoints import StateTarget
from teleop.sim.gimbal.device import SimulatedGimbal

PROFILE = """\
name: Late
links: {gimbal: "sim:"}
axes:
  pan:  {min: LOW, max: HIGH, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50, delay: 0.2, gains: {proportional: 5}}]
"""


def profile(folder: Path, mode: str, low: float = -180, high: float = 180) -> str:
    path = folder / "late.yaml"
    path.write_text(PROFILE.replace("MODE", mode).replace("LOW", str(low)).replace("HIGH", str(high)))
    return str(path)


@pytest.mark.parametrize(
    ("mode", "gimbal", "late"),
    [
        ("position", {}, 0.0),
        ("position", {"reaction": 0.08}, 0.08),
        ("speed", {}, 0.05),
        ("speed", {"lag": 0.12}, 0.12),
        ("speed", {"lag": 0.02, "reaction": 0.06}, 0.08),
        ("stick", {}, 0.05),
        ("stick", {"lag": 0.1, "joystick_speed": (48.0, 30.0, 48.0)}, 0.1),
    ],
)
@pytest.mark.parametrize("axis", ["pan", "tilt"])
def test_a_known_lateness_is_found_to_5_ms(
    axis: str,
    mode: str,
    gimbal: dict[str, float],
    late: float,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The profile's own delay and gains, which would hide it, do not count meanwhile."""
    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", partial(SimulatedGimbal, **gimbal))
    assert run(["calibrate", "delay", "--rig", profile(tmp_path, mode), "--axis", axis, "--fast", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["axis"], found["mode"]) == (axis, mode)
    assert found["delay"] == pytest.approx(late, abs=0.005)
    assert found["spread"] < 0.003


def test_it_says_what_to_write_and_the_profile_takes_it(tmp_path: Path) -> None:
    done = teleop("calibrate", "delay", "--rig", profile(tmp_path, "speed"), "--fast")
    assert done.returncode == 0, done.stderr
    said, _, line = done.stdout.splitlines()
    assert said.startswith("pan moves ")
    assert float(said.split()[2]) == pytest.approx(50, abs=2)
    assert " ms later than commanded in mode speed (spread " in said
    path = tmp_path / "late.yaml"
    path.write_text(path.read_text().replace("delay: 0.2", line.strip()))
    assert load_profile(str(path)).sinks[0].delay == pytest.approx(0.05, abs=0.005)  # type: ignore[union-attr]  # a gimbal


@pytest.mark.parametrize(
    ("mode", "gimbal", "said"),
    [
        ("speed", {"lag": 50.0}, "pan does not follow: commanded"),
        ("stick", {"joystick_speed": (10.0, 10.0, 10.0)}, "check that this gimbal supports this mode"),
    ],
)
def test_a_gimbal_that_does_something_else_has_no_delay(
    mode: str, gimbal: dict[str, object], said: str, tmp_path: Path, monkeypatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", partial(SimulatedGimbal, **gimbal))
    assert run(["calibrate", "delay", "--rig", profile(tmp_path, mode), "--fast"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert said in captured.err


@pytest.mark.parametrize(
    ("arguments", "low", "code", "said"),
    [
        (["--axis", "roll"], -180, 2, "--axis roll: no gimbal of Late moves it"),
        (["--axis", "focus"], -180, 2, "focus"),
        ([], -4, 1, "pan has no room for a test move of 6 deg: move it further in"),
    ],
)
def test_what_cannot_be_measured_is_said(
    arguments: list[str], low: float, code: int, said: str, tmp_path: Path
) -> None:
    done = teleop("calibrate", "delay", "--rig", profile(tmp_path, "speed", low, -low), "--fast", *arguments)
    assert done.returncode == code
    assert said in done.stderr
    assert done.stdout == ""


def test_a_signal_stops_it_as_it_stops_any_run(tmp_path: Path) -> None:
    with running("calibrate", "delay", "--rig", profile(tmp_path, "speed")) as process:
        next(iter(process.stderr))  # type: ignore[arg-type]  # it is a pipe
        process.send_signal(signal.SIGTERM)
        result, said = process.communicate(timeout=DEADLINE)
    assert (process.returncode, result) == (130, "")
    assert said.splitlines()[-1] == "teleop: stopped: SIGTERM received"


@pytest.mark.parametrize(
    ("velocity", "acceleration", "jerk"), [(60, 240, 1200), (2, 240, 1200), (60, 3, 1200), (60, 240, 4)]
)
def test_the_test_move_stays_within_its_share_of_the_limits(velocity: float, acceleration: float, jerk: float) -> None:
    swing = CalibrationMove(Axis.PAN, Limits(-180, 180, velocity, acceleration, jerk), 6.0, 6)
    clock = VirtualClock()
    swing.start(0.0, {Axis.PAN: State(179.0)})
    states: list[StateTarget] = []
    while swing.next_change(clock.now()) <= clock.now():
        clock.sleep_until(clock.now() + 0.01)
        wish = swing.read(clock.now(), NO_FEEDBACK)[0][Axis.PAN]
        assert isinstance(wish, StateTarget)
        states.append(wish)
    assert max(s.position for s in states) == pytest.approx(179.0)
    assert min(s.position for s in states) == pytest.approx(173.0, abs=0.01)
    assert max(abs(s.velocity) for s in states) <= SHARE * velocity
    assert max(abs(s.acceleration) for s in states) <= SHARE * acceleration
    for before, after in pairwise(states):
        assert after.position - before.position == pytest.approx((before.velocity + after.velocity) * 0.005, abs=1e-4)
        assert abs(after.acceleration - before.acceleration) <= SHARE * jerk * 0.01 * 1.05


def test_an_axis_that_is_too_slow_for_it_is_refused() -> None:
    with pytest.raises(UsageError, match="pan: its limits are too low for a test move of 6 deg"):
        CalibrationMove(Axis.PAN, Limits(-180, 180, 0.1, 240, 1200), 6.0, 6)
