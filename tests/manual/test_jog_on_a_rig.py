"""A held key and a turned wheel on the simulated gimbal: the motion on the wire ends soon after the last repeat."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest
import wire
from hands import FakeInput

from teleop.config.inputs_section import ControlSection
from teleop.config.presets import Presets
from teleop.config.profile import load_profile
from teleop.core.axes import Axis, State
from teleop.core.clock import VirtualClock
from teleop.core.events import Tick
from teleop.core.guard_stop import stop_phases
from teleop.core.operator_input import Command, Held
from teleop.core.run_state import Result
from teleop.devices.rig import open_rig
from teleop.dji.gimbal import messages as gimbal
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.state import Change, Sample
from teleop.inputs.keymaps import JogStep, KeyReader
from teleop.manual.operator import Operator
from teleop.manual.recall import at_rest

PROFILE = """\
name: Slow rig
links: {gimbal: "sim:"}
axes:
  pan: {min: -180, max: 180, velocity: 5, acceleration: 10, jerk: 50}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50, delay: DELAY}]
sticks: {start_range: 3}
"""
SHIFT_RIGHT = "\x1b[1;2C"
REPEATS = [0.5 + 0.5 * number / 14 for number in range(15)]  # s: fifteen in half a second
ALLOWED = 0.2  # s from the last repeat to the beginning of the stop
FRAME = 0.02  # s between two commands at 50 Hz
END = 6.0  # s


class Keys(FakeInput):
    """Shift-Right as xterm sends it while it is held."""

    def repeat(self, _now: float) -> None:
        for act in KeyReader().feed(SHIFT_RIGHT):
            assert isinstance(act, JogStep)
            self.turn(act.axis, act.units)
            self.click[act.axis] = abs(act.units)


class Wheel(FakeInput):
    """A HID wheel mapped to pan, four counts at a time; `by` is what a profile says: position or rate."""

    def __init__(self, by: str) -> None:
        super().__init__("wheel")
        self._mapped = Mapped({"Dial": ControlSection.model_validate({"axis": "pan", "by": by})}, relative=["Dial"])
        self._changes: list[Change] = []

    def repeat(self, now: float) -> None:
        self._changes.append(Change(now, "Dial", Sample(4, -127, 127, relative=True)))

    def read(self, now: float) -> Held:
        changes, self._changes = self._changes, []
        held = self._mapped.read({"Dial": Sample(0, -127, 127, relative=True)}, changes, now)
        return Held(held.deflections, held.steps, presses=super().read(now).presses, click=held.click)


class Repeats:
    """Repeats the input at REPEATS, and ends the run at END; `last` is the time of the last repeat."""

    def __init__(self, device: Keys | Wheel) -> None:
        self._device, self._left = device, [*REPEATS]
        self.last = self.begin = float("nan")
        self.fastest = State(0.0)

    def observe(self, tick: Tick) -> None:
        if self.begin != self.begin:  # not yet known
            self.begin = tick.time
        if self._left and tick.time - self.begin >= self._left[0]:
            self._left.pop(0)
            self._device.repeat(tick.time)
            self.last = tick.time
        if tick.motion[Axis.PAN].velocity > self.fastest.velocity:
            self.fastest = tick.motion[Axis.PAN]
        if tick.time - self.begin >= END:
            self._device.press(Command.QUIT)


def last_motion(tap: wire.Tap, mode: str) -> float:
    """When the last command that moves the gimbal was on the wire."""
    if mode == "speed":
        return max(time for time, each in tap.of(gimbal.Speed) if each.yaw)
    aims = [(time, each.yaw) for time, each in tap.of(gimbal.Position)]
    return max(after for (_, one), (after, other) in pairwise(aims) if one != other)


class Run:
    """Pan jogged by `device` on a rig of PROFILE until END."""

    def __init__(self, folder: Path, mode: str, delay: str, device: Keys | Wheel) -> None:
        (folder / "rig.yaml").write_text(PROFILE.replace("MODE", mode).replace("DELAY", delay))
        profile, clock = load_profile(str(folder / "rig.yaml")), VirtualClock(100.0)
        self.limits, self.repeats = profile.limits[Axis.PAN], Repeats(device)
        self.angles: list[tuple[float, float]] = []
        presets = Presets(folder / "presets.yaml")
        with open_rig(profile, clock) as rig:
            self.tap = wire.tapped(rig)
            self._advance, self.tap.gimbal.advance = self.tap.gimbal.advance, self._followed
            operator = Operator(profile.limits, [device], presets, profile.sticks, profile.presets.recall)
            ended = rig.loop([Axis.PAN], [operator], [self.repeats]).run()
        presets.close()
        assert ended.result is Result.DONE
        assert self.repeats.fastest.velocity > 2, "it moved while the key was held"
        stop = sum(seconds for seconds, _ in stop_phases(5, 0, self.limits.acceleration, self.limits.jerk))
        self.latest_rest = stop + ALLOWED + FRAME  # s after the last repeat

    def _followed(self, now: float) -> bytes:
        sent = self._advance(now)
        self.angles.append((now, self.tap.gimbal.angles.yaw))
        return sent

    def at(self, seconds: float) -> float:
        """The gimbal's pan so many seconds after the last repeat."""
        return next(angle for time, angle in self.angles if time >= self.repeats.last + seconds)


@pytest.mark.parametrize(("mode", "delay"), [("position", "0"), ("speed", "0.05")])
@pytest.mark.parametrize(
    "device",
    [Keys, lambda: Wheel("position")],
    ids=["Shift-Right held", "wheel by clicks"],
)
def test_the_gimbal_rests_soon_after_the_last_repeat(
    tmp_path: Path, mode: str, delay: str, device: Callable[[], Keys | Wheel]
) -> None:
    run = Run(tmp_path, mode, delay, device())
    assert 0 < last_motion(run.tap, mode) - run.repeats.last <= run.latest_rest
    ahead = run.angles[-1][1] - run.at(0)
    assert ahead <= at_rest(State(0.0, 5.0), run.limits).position + (ALLOWED + FRAME) * 5 + 0.1  # the gimbal's grid


@pytest.mark.parametrize("device", [Keys, lambda: Wheel("position")], ids=["Shift-Right held", "wheel by clicks"])
def test_a_gimbal_later_than_its_profile_says_goes_back_slowly_to_where_it_was_to_rest(
    tmp_path: Path, device: Callable[[], Keys | Wheel]
) -> None:
    """The command rests in time. What the unmeasured delay left over is leveled: that is the position loop at work."""
    run = Run(tmp_path, "speed", "0", device())
    later = [each for time, each in run.tap.of(gimbal.Speed) if time - run.repeats.last > run.latest_rest]
    assert all(-0.5 < each.yaw <= 0 for each in later), "never on in the direction of the jog"
    assert abs(run.angles[-1][1] - run.at(run.latest_rest)) < 0.2
    assert last_motion(run.tap, "speed") - run.repeats.last < 2
