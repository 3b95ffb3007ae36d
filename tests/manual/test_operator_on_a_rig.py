"""An operator on the simulated gimbal, on virtual time: from one way of moving to the next with no bump on the wire."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import pytest
import wire
from hands import FakeInput

from teleop.config.presets import Presets
from teleop.config.profile import load_profile
from teleop.core.axes import Axis, Motion
from teleop.core.clock import VirtualClock
from teleop.core.events import DeviceCommand, Tick
from teleop.core.operator_input import Command
from teleop.core.run_state import Result, RunStateMachine
from teleop.core.timing import PERIOD
from teleop.devices.gimbal.commands import CommandSink
from teleop.devices.rig import open_rig
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import FollowMode
from teleop.manual.operator import Operator

PROFILE = """\
name: Test rig
links: {gimbal: "sim:"}
axes:
  pan:   {min: -60, max: 60, velocity: 120, acceleration: 240, jerk: 1200}
  tilt:  {min: -56, max: 90, velocity: 90,  acceleration: 180, jerk: 900}
sinks:
  - {type: gimbal, link: gimbal, mode: MODE, rate: 50, delay: 0.05}
  - {type: camera, link: gimbal}
sticks: {start_range: 3}
presets: {recall: 2s}
"""
Script = Sequence[tuple[float, Callable[[FakeInput], object]]]


class Performer:
    """Does what the script says at its times, and keeps the commanded motion: a watcher of the loop."""

    def __init__(self, pad: FakeInput, script: Script) -> None:
        self.history: list[tuple[float, Motion]] = []
        self._pad, self._script = pad, list(script)

    def observe(self, tick: Tick) -> None:
        self.history.append((tick.time, tick.motion))
        elapsed = tick.time - self.history[0][0]
        while self._script and elapsed >= self._script[0][0]:
            self._script.pop(0)[1](self._pad)


class Show:
    """One run of a script on a rig; what came of it."""

    def __init__(self, folder: Path, mode: str, script: Script) -> None:
        (folder / "rig.yaml").write_text(PROFILE.replace("MODE", mode))
        profile = load_profile(str(folder / "rig.yaml"))
        self.pad = FakeInput()
        self.limits = profile.limits
        presets = Presets(folder / "presets.yaml")
        self.operator = Operator(profile.limits, [self.pad], presets, profile.sticks, profile.presets.recall)
        self.performer = Performer(self.pad, script)
        clock = VirtualClock(100.0)
        with open_rig(profile, clock) as rig:
            self.tap = wire.tapped(rig)
            commands = CommandSink(rig.connections["gimbal"], self.operator.notify)
            loop = rig.loop(list(profile.axes), [self.operator], [self.performer], [commands])
            self.ended: RunStateMachine = loop.run()
            self.tap.gimbal.advance(clock.now() + 1)
        presets.close()

    def words(self) -> list[str]:
        return [message.text for message in reversed(self.operator.status.messages)]


def press(
    command: Command, number: int = 0, device_command: DeviceCommand | None = None
) -> Callable[[FakeInput], object]:
    return lambda pad: pad.press(command, number, device_command)


def hold(**deflections: float) -> Callable[[FakeInput], object]:
    return lambda pad: pad.hold(**deflections)


EVERYTHING: Script = [
    (0.2, hold(pan=0.5, tilt=-0.3)),
    (0.9, press(Command.STORE, 1)),
    (1.0, hold(pan=-1.0)),
    (2.2, hold()),
    (2.9, press(Command.RECALL, 1)),
    (3.9, hold(tilt=1.0)),
    (4.5, hold()),
    (4.6, press(Command.RECALL, 1)),
    (5.5, press(Command.STOP)),
    (5.6, press(Command.CLEAR)),
    (5.7, hold(pan=1.0, tilt=1.0)),
    (7.5, press(Command.SLOWER)),
    (7.9, lambda pad: setattr(pad, "trouble", "pad: unplugged")),
    (8.5, lambda pad: setattr(pad, "trouble", "")),
    (8.6, hold()),
    (8.7, lambda pad: pad.turn(Axis.PAN, -10.0)),
    (8.8, lambda pad: pad.turn(Axis.PAN, -10.0)),
    (9.4, press(Command.RECENTER)),
    (11.8, press(Command.QUIT)),
]


@pytest.mark.parametrize("mode", ["position", "speed"])
def test_from_stick_to_recall_to_stop_and_on_there_is_no_bump(tmp_path: Path, mode: str) -> None:
    show = Show(tmp_path, mode, EVERYTHING)
    assert (show.ended.result, show.ended.reasons) == (Result.DONE, [])
    for (before_at, before), (at, after) in pairwise(show.performer.history):
        seconds = at - before_at
        assert seconds == pytest.approx(PERIOD)
        for axis, of in show.limits.items():
            assert of.minimum - 1e-6 <= after[axis].position <= of.maximum + 1e-6
            assert abs(after[axis].velocity) <= of.velocity * (1 + 1e-6)
            assert abs(after[axis].acceleration) <= of.acceleration * (1 + 1e-6)
            assert abs(after[axis].acceleration - before[axis].acceleration) <= of.jerk * seconds * (1 + 1e-6)
            middle = (before[axis].velocity + after[axis].velocity) / 2
            rounding = of.jerk * seconds**3
            assert after[axis].position - before[axis].position == pytest.approx(middle * seconds, abs=rounding)
    assert show.tap.gimbal.angles.yaw == pytest.approx(0, abs=0.15)
    assert show.tap.gimbal.angles.pitch == pytest.approx(0, abs=0.15)
    assert not show.tap.gimbal.controlled
    assert [word for word in show.words() if "STOP by" in word or "unplugged" in word] == [
        "STOP by pad. Press c to clear, then center all sticks.",
        "pad: unplugged: pan and tilt stopped",
    ]


def test_nothing_on_the_wire_jumps(tmp_path: Path) -> None:
    show = Show(tmp_path, "position", EVERYTHING)
    aims = [(time, message.yaw) for time, message in show.tap.of(gimbal.Position)]
    assert len(aims) > 200
    for (before_at, before), (at, after) in pairwise(aims):
        # An aim lies 0.1 s ahead: it also moves with the change of velocity over a period.
        assert abs(after - before) <= 120 * (at - before_at) + 240 * (at - before_at) * 0.2 + 0.1
        assert -60.05 <= after <= 60.05


def test_the_camera_is_stopped_however_a_recording_ends(tmp_path: Path) -> None:
    words = camera.CameraCommand
    for last in (press(Command.QUIT), _fail):
        show = Show(tmp_path, "position", [(0.2, press(Command.RECORD)), (1.0, last), (1.5, press(Command.QUIT))])
        commands = [message.command for _, message in show.tap.of(camera.Command)]
        assert commands == [words.RECORD, words.STOP]
        assert not show.tap.gimbal.recording
        assert (show.ended.result is Result.DONE) == (last is not _fail)


def _fail(pad: FakeInput) -> None:
    raise RuntimeError("a defect")


def test_follow_modes_and_the_dial_arrive_and_the_dial_ends_at_zero(tmp_path: Path) -> None:
    show = Show(
        tmp_path,
        "position",
        [
            (0.2, press(Command.TELL, device_command=DeviceCommand("gimbal", "follow lock"))),
            (0.5, lambda pad: setattr(pad, "dial", -1.0)),
            (1.5, press(Command.QUIT)),
        ],
    )
    assert [message.mode for _, message in show.tap.of(gimbal.Mode)] == [FollowMode.LOCK]
    speeds = [message.speed for _, message in show.tap.of(gimbal.Dial)]
    assert speeds[:-1] == [-2048] * (len(speeds) - 1)
    assert len(speeds) == pytest.approx(51, abs=2)
    assert speeds[-1] == 0
    assert show.words()[-1] == "gimbal follow lock: done"
