"""The whole path, from a file through real frames to a simulated gimbal that obeys nothing else, on virtual time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import pytest
import wire

from teleop.config.profile import Profile, load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.control_loop import ControlLoop
from teleop.core.events import Tick
from teleop.core.interfaces import Observer
from teleop.core.run_state import Result
from teleop.devices.rig import Rig, open_rig
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.inputs.recorded_sticks import SticksSource, read_sticks
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.sequence.compile import load_sequence
from teleop.sequence.source import SequenceSource

PROFILE = """\
name: Test rig
links: {gimbal: "sim:"}
axes:
  pan:   {min: -180, max: 180, velocity: 120, acceleration: 240, jerk: 1200}
  tilt:  {min: -56,  max: 146, velocity: 90,  acceleration: 180, jerk: 900}
  roll:  {min: -30,  max: 30,  velocity: 60,  acceleration: 120, jerk: 600}
  focus: {min: 0,    max: 1,   velocity: 0.5, acceleration: 2,   jerk: 10}
sinks:
  - {type: gimbal, link: gimbal, mode: MODE, rate: 50}
  - {type: focus, link: gimbal, rate: 50}
  - {type: camera, link: gimbal}
"""
MOVE = """\
keyframes:
  - {at: 0,  pan: 0,   tilt: 0,  roll: 0, focus: 0.1}
  - {at: 3,  pan: 40,  tilt: -15}
  - {at: 5,  pan: 70,  roll: 8,  hold: 1s}
  - {at: 10, pan: -30, tilt: 20, roll: -4, focus: 0.9}
cues:
  - {at: 0,  camera: record}
  - {at: 6,  camera: shutter}
  - {at: 10, camera: stop}
"""
MODES = ["position", "speed", "stick"]


class Stage:
    """A rig on virtual time, and one run of a move or of sticks on it."""

    def __init__(self, folder: Path, mode: str, change: Callable[[str], str] = lambda text: text) -> None:
        profile = PROFILE.replace("MODE", mode)
        if mode == "stick":  # what full deflection gives on the simulated gimbal
            profile = profile.replace("velocity: 60", "velocity: 30").replace("velocity: 120", "velocity: 60")
            profile = profile.replace("velocity: 90", "velocity: 60")
        (folder / "rig.yaml").write_text(change(profile))
        self.folder = folder
        self.profile: Profile = load_profile(str(folder / "rig.yaml"))
        self.clock = VirtualClock(100.0)
        self.tally: TrackingErrorMonitor

    @contextmanager
    def rig(self) -> Iterator[tuple[Rig, wire.Tap]]:
        with open_rig(self.profile, self.clock) as rig:
            yield rig, wire.tapped(rig)

    def playing(
        self, rig: Rig, move: str = MOVE, observers: Sequence[Observer] = ()
    ) -> tuple[ControlLoop, SequenceSource]:
        (self.folder / "move.yaml").write_text(move)
        performance = load_sequence(str(self.folder / "move.yaml"), self.profile.limits, "the rig")
        source = SequenceSource(performance, self.profile.limits)
        self.tally = TrackingErrorMonitor(lambda: source.begin)
        return rig.loop(list(performance.move.tracks), [source], [self.tally, *observers]), source

    def on_sticks(self, rig: Rig, rows: str) -> ControlLoop:
        (self.folder / "sticks.csv").write_text(rows)
        sticks = read_sticks(self.folder / "sticks.csv", list(self.profile.axes))
        limits = self.profile.limits
        source = SticksSource(sticks, lambda axis, deflection: deflection * limits[axis].velocity)
        self.tally = TrackingErrorMonitor(lambda: source.begin)
        return rig.loop(sticks.axes, [source], [self.tally])


@pytest.mark.parametrize(
    ("mode", "delay", "rms", "peak"),
    [("position", 0, 0.08, 0.2), ("speed", 0, 0.5, 1.2), ("speed", 0.05, 0.08, 0.2), ("stick", 0.05, 0.08, 0.2)],
)
def test_a_move_is_followed_on_every_axis(tmp_path: Path, mode: str, delay: float, rms: float, peak: float) -> None:
    stage = Stage(tmp_path, mode, lambda text: text.replace("rate: 50", f"delay: {delay}, rate: 50", 1))
    with stage.rig() as (rig, tap):
        loop, _ = stage.playing(rig)
        ended = loop.run()
        yaw, roll, pitch = tap.gimbal.angles
    assert (ended.result, ended.reasons) == (Result.DONE, [])
    assert (yaw, pitch, roll) == (
        pytest.approx(-30, abs=0.15),
        pytest.approx(20, abs=0.15),
        pytest.approx(-4, abs=0.15),
    )
    for axis in (Axis.PAN, Axis.TILT, Axis.ROLL):
        score = stage.tally.scores[axis]
        assert score.readings > 200
        assert score.rms < rms
        assert score.peak < peak
    assert stage.tally.scores[Axis.FOCUS].rms < 0.01


def test_the_camera_records_and_shoots_on_its_cues(tmp_path: Path) -> None:
    stage = Stage(tmp_path, "position")
    with stage.rig() as (rig, tap):
        loop, source = stage.playing(rig)
        loop.run()
        commands = [(round(time - source.begin, 2), message.command) for time, message in tap.of(camera.Command)]
        assert tap.gimbal.shutter_count == 1
        assert not tap.gimbal.recording
    words = camera.CameraCommand
    assert commands == [(0, words.RECORD), (6, words.SHUTTER), (10, words.STOP)]


@pytest.mark.parametrize("mode", MODES)
def test_signs_of_the_profile_turn_an_axis_round(tmp_path: Path, mode: str) -> None:
    stage = Stage(tmp_path, mode, lambda text: text.replace("rate: 50}", "rate: 50, signs: {pan: -1, roll: -1}}", 1))
    with stage.rig() as (rig, tap):
        loop, _ = stage.playing(rig)
        assert loop.run().result is Result.DONE
        yaw, roll, pitch = tap.gimbal.angles
    assert (yaw, pitch, roll) == (pytest.approx(30, abs=0.15), pytest.approx(20, abs=0.15), pytest.approx(4, abs=0.15))


def test_axes_that_no_keyframe_names_are_left_alone(tmp_path: Path) -> None:
    stage = Stage(tmp_path, "position")
    with stage.rig() as (rig, tap):
        loop, _ = stage.playing(rig, "keyframes:\n  - {at: 0, tilt: 0}\n  - {at: 2, tilt: 10}\n")
        assert loop.run().result is Result.DONE
        commands = [message for _, message in tap.of(gimbal.Position)]
        assert commands
        assert all(c.yaw_ignored and c.roll_ignored and not c.pitch_ignored for c in commands)
        assert tap.of(focus.Set) == tap.of(focus.Get) == []


def test_the_gimbal_is_told_our_version_once_a_second(tmp_path: Path) -> None:
    stage = Stage(tmp_path, "position")
    with stage.rig() as (rig, tap):
        loop, _ = stage.playing(rig)
        begun = stage.clock.now()
        loop.run()
        pushes = tap.of(gimbal.VersionPush)
        assert len(pushes) == pytest.approx(stage.clock.now() - begun, abs=2)
        assert tap.gimbal.settings.host_version == pushes[0][1].version == "00.02.00.00"


@pytest.mark.parametrize("mode", MODES)
def test_commands_keep_their_rate_while_moving(tmp_path: Path, mode: str) -> None:
    stage = Stage(tmp_path, mode)
    kind = {"position": gimbal.Position, "speed": gimbal.Speed, "stick": gimbal.Joystick}[mode]
    with stage.rig() as (rig, tap):
        loop, source = stage.playing(rig)
        loop.run()
        times = [time for time, _ in tap.of(kind) if source.begin + 0.1 < time < source.begin + 9.9]
    spacing = [after - before for before, after in pairwise(times)]
    assert min(spacing) > 0.015
    assert sum(spacing) / len(spacing) < 0.0225 if mode != "position" else max(spacing) < 0.5


def test_speed_control_is_taken_over_and_given_back_after_zero_speed(tmp_path: Path) -> None:
    stage = Stage(tmp_path, "speed")
    with stage.rig() as (rig, tap):
        loop, _ = stage.playing(rig)
        loop.run()
        speeds = tap.of(gimbal.Speed)
        assert not tap.gimbal.controlled
    assert all(message.take_over for _, message in speeds[:-1])
    assert not speeds[-1][1].take_over
    assert max(after - before for (before, _), (after, _) in pairwise(speeds)) < 0.5
    zeros = speeds[-4:-1]
    assert all((m.yaw, m.roll, m.pitch) == (0, 0, 0) for _, m in zeros)
    assert [round(after - before, 2) for (before, _), (after, _) in pairwise(zeros)] == [0.05, 0.05]


STICKS = "time,pan,tilt\n0,0,0\n0.5,1,-0.5\n4,-0.25,0\n6,0,0\n"


@pytest.mark.parametrize("mode", MODES)
def test_sticks_move_the_gimbal_and_the_run_ends_at_rest(tmp_path: Path, mode: str) -> None:
    stage = Stage(tmp_path, mode, lambda text: text.replace("mode: s", "delay: 0.05, mode: s"))
    with stage.rig() as (rig, tap):
        ended = stage.on_sticks(rig, STICKS).run()
        assert (ended.result, ended.reasons) == (Result.DONE, [])
        tap.gimbal.advance(stage.clock.now() + 1)
        assert max(abs(rate) for rate in tap.gimbal.rates) < 1e-3
        assert stage.tally.scores[Axis.PAN].rms < 0.5
        # full pan for 3.5 s comes to the soft limit, or near; then back at a quarter of the speed for 2 s
        speed = stage.profile.axes[Axis.PAN].velocity
        turned = min(180, 3.5 * speed) - 2 * speed / 4
        assert tap.gimbal.angles[0] == pytest.approx(turned, abs=speed / 20)


@pytest.mark.parametrize("mode", MODES)
def test_nothing_sent_aims_beyond_a_soft_limit(tmp_path: Path, mode: str) -> None:
    stage = Stage(
        tmp_path,
        mode,
        lambda text: text.replace("min: -180, max: 180", "min: -20, max: 35").replace(
            "rate: 50", "delay: 0.05, rate: 50", 1
        ),
    )
    with stage.rig() as (rig, tap):
        stage.on_sticks(rig, "time,pan\n0,1\n3,-1\n8,0\n").run()
        assert all(-20 <= message.yaw <= 35 for _, message in tap.of(gimbal.Position))
        assert -20.2 < tap.gimbal.angles[0] < 35.2


def test_a_continuous_axis_turns_on_and_on(tmp_path: Path) -> None:
    stage = Stage(
        tmp_path,
        "speed",
        lambda text: text.replace("min: -180, max: 180", "min: null, max: null").replace(
            "rate: 50", "delay: 0.05, rate: 50", 1
        ),
    )
    with stage.rig() as (rig, _):
        ended = stage.on_sticks(rig, "time,pan\n0,1\n10,0\n11,0\n").run()
        assert ended.result is Result.DONE
        assert stage.tally.ends(Axis.PAN)[0] > 1000
        assert stage.tally.scores[Axis.PAN].peak < 3


class At:
    """A watcher that does something once, at a time of the performance."""

    def __init__(self, time: float) -> None:
        self.time = time
        self.begin: Callable[[], float] = lambda: math.inf
        self.action: Callable[[float], None] = lambda _now: None
        self.done_at = math.inf

    def observe(self, tick: Tick) -> None:
        if tick.time >= self.begin() + self.time and self.done_at == math.inf:
            self.done_at = tick.time
            self.action(tick.time)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("fault", ["mute", "deaf", "both", "interrupt"])
def test_a_fault_mid_move_stops_within_two_seconds(tmp_path: Path, mode: str, fault: str) -> None:
    stage, trigger = Stage(tmp_path, mode), At(8.0)
    with stage.rig() as (rig, tap):
        loop, source = stage.playing(rig, observers=[trigger])

        def cut(now: float) -> None:
            if fault in ("mute", "both"):
                tap.mute_from = now
            if fault in ("deaf", "both"):
                tap.deaf_from = now
            if fault == "interrupt":
                loop.interrupt("SIGTERM received")

        trigger.begin, trigger.action = lambda: source.begin, cut
        ended = loop.run()
        assert abs(stage.tally.ends(Axis.PAN)[0] - 70) > 20, "the fault must come while it moves"
        assert stage.clock.now() - trigger.done_at < 2
        stage.clock.sleep_until(stage.clock.now() + 1)
        tap.gimbal.advance(stage.clock.now())
        assert all(abs(rate) < 0.01 for rate in tap.gimbal.rates)
        assert not tap.gimbal.controlled or fault in ("deaf", "both")
    assert ended.result is (Result.INTERRUPTED if fault == "interrupt" else Result.FAILED)
    assert ("SIGTERM received" if fault == "interrupt" else "does not answer") in ended.reasons[0]


def test_six_hours_of_rest_and_moves_pass_in_seconds(tmp_path: Path) -> None:
    hours = "".join(f"  - {{at: {hour}h, pan: {10 * hour}, hold: 59m50s}}\n" for hour in range(6))
    stage = Stage(tmp_path, "position")
    with open_rig(stage.profile, stage.clock) as rig:
        loop, source = stage.playing(rig, f"keyframes:\n{hours}  - {{at: 6h, pan: 0}}\n")
        ended = loop.run()
        assert (ended.result, ended.reasons) == (Result.DONE, [])
        assert stage.clock.now() - source.begin > 6 * 3600
        assert rig.simulated["gimbal"].angles.yaw == pytest.approx(0, abs=0.15)
    assert stage.tally.scores[Axis.PAN].peak < 1
