"""A gimbal whose mount is turned: the seam of +-180 is behind, for readings and commands, in every mode."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
import wire
from hypothesis import given
from hypothesis import strategies as st

from teleop.cli import run
from teleop.config.documents.document import DocumentError
from teleop.config.profile import load_profile
from teleop.config.wiring import Wiring
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.devices.rig import open_rig
from teleop.dji.gimbal import messages as gimbal
from teleop.sequence.compile import load_sequence
from teleop.sequence.source import SequenceSource

PROFILE = """
name: Underslung
links: {gimbal: "sim:"}
axes:
  pan:  {min: -90, max: 90, velocity: 60, acceleration: 120, jerk: 600}
  tilt: {min: -40, max: 60, velocity: 60, acceleration: 120, jerk: 600}
sinks:
  - {type: gimbal, link: gimbal, mode: MODE, rate: 50, delay: DELAY, mount: {yaw: MOUNT}MORE}
"""
MOVE = """
keyframes:
  - {at: 0, pan: 0, tilt: 0}
  - {at: 2, pan: 60}
  - {at: 5, pan: -60, tilt: 10}
  - {at: 7, pan: 0, tilt: 0}
"""


def written(folder: Path, mode: str = "position", mount: float = 180, more: str = "") -> str:
    path = folder / "rig.yaml"
    delay = "0" if mode == "position" else "0.05"
    text = PROFILE.replace("MODE", mode).replace("DELAY", delay)
    path.write_text(text.replace("MOUNT", str(mount)).replace("MORE", more))
    return str(path)


class Watch:
    """Keeps where pan was planned and measured in each tick."""

    def __init__(self) -> None:
        self.pairs: list[tuple[float, float]] = []

    def observe(self, tick: Tick) -> None:
        if reading := tick.reported.get(Axis.PAN):
            self.pairs.append((tick.motion[Axis.PAN].position, reading.position))


@pytest.mark.parametrize(
    ("mode", "mount", "more"),
    [
        ("position", 180, ""),
        ("speed", 180, ""),
        ("stick", 180, ""),
        ("position", -180, ", signs: {pan: -1}"),
        ("position", 135.5, ", report_signs: {pan: -1}"),
        ("speed", -150, ", signs: {pan: -1}, speed_signs: {pan: 1}"),
    ],
)
def test_a_gimbal_that_starts_turned_pans_through_the_seam_without_a_jump(
    mode: str, mount: float, more: str, tmp_path: Path
) -> None:
    profile = load_profile(written(tmp_path, mode, mount, more))
    (tmp_path / "move.yaml").write_text(MOVE)
    watch = Watch()
    with open_rig(profile, VirtualClock(100.0)) as rig:
        tap = wire.tapped(rig)
        move = load_sequence(str(tmp_path / "move.yaml"), profile.limits, "the rig")
        source = SequenceSource(move, profile.limits)
        started = tap.gimbal.angles.yaw
        ended = rig.loop(list(move.move.tracks), [source], [watch]).run()
        turned = tap.gimbal.angles.yaw - started
    assert (ended.result, ended.reasons) == (Result.DONE, [])
    assert abs(started) == abs(mount)
    assert turned == pytest.approx(0.0, abs=0.3), "it came back by the way it went"
    measured = [reading for _, reading in watch.pairs]
    assert max(measured) > 59
    assert min(measured) < -59
    assert max(abs(after - before) for before, after in pairwise(measured)) < 8, "no jump of a turn"
    assert max(abs(plan - reading) for plan, reading in watch.pairs) < 8
    yaws = [message.yaw for _, message in tap.of(gimbal.Position)]
    steps = [abs((after - before + 180) % 360 - 180) for before, after in pairwise(yaws)]
    if mode == "position":
        assert max(steps) < 3, "no command sends it round the other way"
        assert max(yaws) - min(yaws) > 300 or abs(mount) < 170, "the wire's own seam is crossed"


def test_without_the_mount_the_same_gimbal_is_half_a_turn_away(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What the key is for: its reading of 180 is beyond the soft limits."""
    (tmp_path / "move.yaml").write_text(MOVE)
    rig = written(tmp_path, mount=0, more=", simulated: {mount: 180}")
    assert run(["play", str(tmp_path / "move.yaml"), "--rig", rig, "--fast"]) != 0
    assert "180" in capsys.readouterr().err


@given(st.floats(-360, 360), st.floats(-170, 170), st.sampled_from([1, -1]), st.sampled_from([1, -1]))
def test_what_is_commanded_is_what_is_read(mount: float, pan: float, sign: int, report: int) -> None:
    wiring = Wiring(signs={Axis.PAN: sign}, report_signs={Axis.PAN: report}, mount=mount)
    yaw, _, _ = wiring.to_gimbal({Axis.PAN: pan})
    assert -180 <= yaw <= 180
    assert wiring.from_gimbal(sign * report * yaw, 0.0, 0.0)[Axis.PAN] == pytest.approx(pan, abs=1e-9)


def test_an_axis_that_is_not_driven_gets_no_mount() -> None:
    assert Wiring(mount=180).to_gimbal({Axis.TILT: 5.0}) == (0.0, 0.0, 5.0)


def test_a_calibration_works_at_the_seam(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rig = written(tmp_path, "speed")
    assert run(["calibrate", "signs", "--rig", rig, "--axis", "pan", "--fast"]) == 0, capsys.readouterr().err


def test_send_tells_what_its_yaw_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "gimbal", "angles", "--rig", written(tmp_path)]) == 0
    assert "yaw is the gimbal's own; the mount of Underslung has pan 0 at yaw 180" in capsys.readouterr().err


@pytest.mark.parametrize("mount", ["{yaw: 361}", "{pan: 180}", "{roll: 180}", "180", "{yaw: back}"])
def test_a_mount_that_cannot_be_is_refused(mount: str, tmp_path: Path) -> None:
    path = Path(written(tmp_path))
    path.write_text(path.read_text().replace("{yaw: 180}", mount))
    with pytest.raises(DocumentError, match="mount"):
        load_profile(str(path))
