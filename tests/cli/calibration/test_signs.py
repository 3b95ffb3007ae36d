"""`teleop calibrate signs`: on simulated gimbals with every combination of signs, and what cannot be measured."""

from __future__ import annotations

import json
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from teleop.app.calibration.sign_probe import SignProbe
from teleop.cli import run
from teleop.config.profile import Profile, load_profile
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import Wiring
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.control_loop import ControlLoop
from teleop.core.operator_input import Command, Held, Press
from teleop.core.run_state import RunState
from teleop.core.timing import PERIOD
from teleop.devices.gimbal.position import Angles
from teleop.devices.rig import open_rig
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message
from teleop.manual.stop_guard import Relay, StopGuard
from teleop.planner.live import Live
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.firmware import DOCUMENTED

PROFILE = """\
name: Signs
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 60, acceleration: 180, jerk: 900}
  roll: {min: ROLL, max: 30,  velocity: 60, acceleration: 120, jerk: 600}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50MORE}]
"""
BOOT = (20.0, 3.0, -10.0)
CLAIMED = ("", ", signs: {pan: -1}", ", speed_signs: {roll: -1, tilt: 1}", ", report_signs: {pan: -1}")


class Turned(SimulatedGimbal):
    """Counts speeds, and the angles that it reports, by signs (yaw, roll, pitch) of their own; never moves far."""

    last: Turned

    def __init__(self, speed: tuple[int, int, int], report: tuple[int, int, int], **settings: Any) -> None:
        super().__init__(**{**settings, "boot": BOOT, "firmware": DOCUMENTED})  # whatever the profile claims
        Turned.last = self
        self.farthest = 0.0
        handlers = dict(self._handlers)
        for kind in (gimbal.Speed, gimbal.Joystick):
            self._handlers[kind] = lambda message, now, kind=kind: handlers[kind](turned(message, speed), now)
        self._handlers[gimbal.Angles] = lambda message, now: turned(handlers[gimbal.Angles](message, now), report)

    def receive(self, data: bytes, now: float) -> None:
        super().receive(data, now)
        moved = (abs(angle - at) for angle, at in zip(self.angles, BOOT, strict=True))
        self.farthest = max(self.farthest, *moved)


def turned(message: Any, signs: tuple[int, int, int]) -> Any:
    assert isinstance(message, Message)
    yaw, roll, pitch = signs
    return replace(message, yaw=yaw * message.yaw, roll=roll * message.roll, pitch=pitch * message.pitch)  # type: ignore[call-arg]


def rig(folder: Path, mode: str, more: str = "", roll: float = -30) -> Path:
    path = folder / "rig.yaml"
    path.write_text(PROFILE.replace("MODE", mode).replace("MORE", more).replace("ROLL", str(roll)))
    return path


@pytest.mark.parametrize("claimed", CLAIMED)
@pytest.mark.parametrize("mode", ["position", "speed", "stick"])
@pytest.mark.parametrize(
    ("speed", "report"), [((1, 1, 1), (1, 1, 1)), ((1, -1, 1), (1, 1, 1)), ((-1, 1, -1), (1, 1, -1))]
)
def test_what_it_prints_makes_speeds_and_reports_agree_with_positions(
    speed: tuple[int, int, int],
    report: tuple[int, int, int],
    mode: str,
    claimed: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", lambda **settings: Turned(speed, report, **settings))
    path = rig(tmp_path, mode, claimed)
    assert run(["calibrate", "signs", "--rig", str(path), "--fast"]) == 0
    assert Turned.last.farthest < 0.8
    assert Turned.last.angles == pytest.approx(BOOT, abs=0.11), "it ends where it began"
    assert not Turned.last.controlled
    lines = [line.strip() for line in capsys.readouterr().out.splitlines() if line.startswith("    ")]
    rig(tmp_path, mode, "".join(f", {line}" for line in lines))
    [section] = load_profile(str(path)).sinks
    assert isinstance(section, GimbalSection)
    for number, axis in enumerate(axis for axis in section.axes if axis is not None):
        sign = section.wiring.sign(axis)
        assert sign == (-1 if "signs: {pan: -1" in claimed and axis == "pan" and "report" not in claimed else 1)
        assert section.wiring.report_sign(axis) == sign * report[number]
        assert section.wiring.speed_sign(axis) == sign * speed[number]


def test_signs_of_the_firmware_noise_and_lag_do_not_matter_and_json_has_it_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    late = partial(SimulatedGimbal, signs=(-1, 1, -1), boot=BOOT, lag=0.2, reaction=0.1)
    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", late)
    assert run(["calibrate", "signs", "--rig", str(rig(tmp_path, "speed")), "--fast", "--axis", "tilt", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["result"] == "done"
    assert found["measured"] == {"tilt": {"position": 1, "speed": 1}}
    assert found["speed_signs"] == {"tilt": 1}


def test_an_axis_without_room_does_not_move(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        "teleop.devices.rig.SimulatedGimbal", lambda **settings: Turned((1, 1, 1), (1, 1, 1), **settings)
    )
    assert run(["calibrate", "signs", "--rig", str(rig(tmp_path, "speed", roll=2.8)), "--fast"]) == 1
    assert "roll has no room for a test move of 0.5 deg: move it further in" in capsys.readouterr().err
    assert Turned.last.farthest == 0.0


def test_an_axis_that_is_held_is_said_and_speed_control_is_given_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def held(**settings: Any) -> SimulatedGimbal:
        made = Turned((1, 1, 1), (1, 1, 1), **settings)
        made.hold(0.0, roll=True)
        return made

    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", held)
    assert run(["calibrate", "signs", "--rig", str(rig(tmp_path, "speed")), "--fast"]) == 1
    assert "roll did not move by a position command" in capsys.readouterr().err
    assert not Turned.last.controlled


def test_a_gimbal_that_ignores_speeds_has_no_sign_of_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        "teleop.devices.rig.SimulatedGimbal", lambda **settings: Turned((0, 0, 0), (1, 1, 1), **settings)
    )
    assert run(["calibrate", "signs", "--rig", str(rig(tmp_path, "position")), "--fast", "--axis", "pan"]) == 0
    said = capsys.readouterr().out
    assert "pan: speed commands go nowhere" in said
    assert "speed_signs" not in said


def test_a_rig_that_has_no_such_axis_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = rig(tmp_path, "speed", ", mapping: {yaw: pan, pitch: tilt}")
    path.write_text("".join(line for line in path.read_text().splitlines(keepends=True) if "roll" not in line))
    assert run(["calibrate", "signs", "--rig", str(path), "--axis", "roll"]) == 2
    assert "--axis roll: no gimbal of Signs moves it" in capsys.readouterr().err


@pytest.mark.parametrize("mode", ["position", "speed", "stick"])
def test_stop_holds_the_axis_and_releases_it_then_it_is_measured_anew(mode: str, tmp_path: Path) -> None:
    bench = Measuring(load_profile(str(rig(tmp_path, mode))))
    while not bench.moved:
        bench.turn()
    bench.press(Command.STOP)
    bench.turn(0.5)
    rest = bench.device.angles
    bench.turn(3.0)
    assert bench.device.angles == rest
    assert not bench.device.controlled
    assert not bench.probe.done
    bench.press(Command.CLEAR)
    bench.turn(0.1)
    bench.press(Command.GO)
    bench.turn(40.0)
    assert bench.probe.done
    assert set(bench.probe.signs) == {Axis.PAN, Axis.TILT, Axis.ROLL}
    assert bench.device.angles == pytest.approx((0, 0, 0), abs=0.21)


class Measuring:
    """The probe under its guard, on the wire of a simulated gimbal and the virtual clock."""

    def __init__(self, profile: Profile) -> None:
        self.clock = VirtualClock()
        self._stack = ExitStack()
        self._rig = self._stack.enter_context(open_rig(profile, self.clock))
        [section] = profile.sinks
        assert isinstance(section, GimbalSection)
        self.device = self._rig.simulated[section.link]
        connection = self._rig.connections[section.link]
        full = None if section.mode != "stick" else lambda each: section.full(each, profile.limits[each].velocity)
        self.probe = SignProbe(connection, list(profile.limits), section.wiring, profile.limits, full)
        self._held: list[Press] = []
        guard = StopGuard(self.probe, [Relay(self)])
        reporter = Angles(connection, Wiring(section.axes), section.legacy_angles)
        self._loop = ControlLoop(
            self.clock, Live(profile.limits, PERIOD), profile.limits, [guard], [self.probe], [reporter]
        )
        self._begin = self.device.angles

    name = "keys"

    def read(self, now: float) -> Held:
        held, self._held = Held(presses=self._held), []
        return held

    def press(self, command: Command) -> None:
        self._held = [Press(command)]

    @property
    def moved(self) -> bool:
        return any(abs(now - before) > 0.15 for now, before in zip(self.device.angles, self._begin, strict=True))

    def turn(self, seconds: float = 0.0) -> None:
        """At least one tick, and no more than the run has."""
        end = self.clock.now() + seconds
        self._loop.turn()
        while self.clock.now() < end and self._loop.supervisor.state is not RunState.OVER:
            self._loop.turn()
