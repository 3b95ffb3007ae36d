"""What `teleop play` refuses or reads by itself: percentages, what a timelapse and a flown move have no use for."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.cli import run
from teleop.cli.play import percentage, the_clock
from teleop.config.documents.document import DocumentError
from teleop.config.profile import load_profile
from teleop.core.clock import SystemClock, VirtualClock

TIMELAPSE = """
fps: 24
keyframes: [{at: 0, pan: -30}, {at: 2, pan: 60}]
timelapse: {frames: 3, interval: 2s, exposure: 0.2s}
"""


@pytest.mark.parametrize(("text", "share"), [("150%", 1.5), ("50", 0.5), (" 100 %", 1.0), ("0.5%", 0.005)])
def test_a_percentage_with_or_without_its_sign_is_a_share(text: str, share: float):
    assert percentage("--speed", text) == pytest.approx(share)


@pytest.mark.parametrize("text", ["0", "-5%", "fast", "inf", "nan", "", "5%%"])
def test_what_is_no_percentage_above_0_is_refused_by_the_option_s_name(text: str):
    with pytest.raises(DocumentError, match=r"--speed .*: must be a percentage above 0"):
        percentage("--speed", text)


def test_only_simulated_links_run_on_simulated_time():
    real = load_profile("sim", {"gimbal": "socketcan:can0"})
    assert isinstance(the_clock(False, real), SystemClock)
    assert isinstance(the_clock(True, load_profile("sim")), VirtualClock)
    with pytest.raises(DocumentError, match="--fast: gimbal=socketcan:can0 runs in real time"):
        the_clock(True, real)


@pytest.mark.parametrize("option", [["--speed", "50%"], ["--passes", "2"]])
def test_a_timelapse_is_shot_as_it_is_written(tmp_path: Path, option: list[str], capsys: pytest.CaptureFixture[str]):
    (tmp_path / "dusk.yaml").write_text(TIMELAPSE)
    assert run(["play", str(tmp_path / "dusk.yaml"), "--rig", "sim", "--fast", *option]) == 2
    assert "need --rehearse" in capsys.readouterr().err
    assert not (tmp_path / "dusk.journal").exists()


@pytest.mark.parametrize(
    ("option", "reason"), [(["--speed", "50%"], "has one speed"), (["--start-at", "1s"], "starts at its first key")]
)
def test_a_flown_move_has_one_speed_and_one_start(option: list[str], reason: str, capsys: pytest.CaptureFixture[str]):
    assert run(["play", "fly-by", "--rig", "sim-drone", "--fast", *option]) == 2
    assert reason in capsys.readouterr().err
