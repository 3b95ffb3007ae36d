"""`teleop play` of a timelapse as typed: what is said, what is left behind, and what is refused."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest
from command import TELEOP, running, teleop
from waiting import DEADLINE

from teleop.config.profile import load_profile
from teleop.config.resources import find
from teleop.timelapse.compile import load_timelapse

FILE = """
title: Dusk
fps: 24
keyframes:
  - {at: 0, pan: -10}
  - {at: 11, pan: 10}
timelapse: {frames: 12, interval: 1.2s, exposure: 0.1s}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "dusk.yaml").write_text(FILE)
    return tmp_path


def shot(folder: Path, *arguments: str) -> dict:
    done = teleop("play", "dusk.yaml", "--fast", "--json", *arguments, cwd=folder)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_shoot_reports_its_frames_and_can_be_shot_again(folder: Path) -> None:
    report = shot(folder)
    assert (report["result"], report["frames"], report["shot"]) == ("done", 12, 12)
    assert (report["missed"], report["lost"], report["doubtful"], report["in_doubt"]) == (0, [], [], None)
    assert report["seconds"] == pytest.approx(11 * 1.2, abs=0.3)
    assert report["clip"] == 0.5
    assert report["disk_free"] > 0
    assert report["journal"] == "dusk.journal"
    done = teleop("play", "dusk.yaml", "--fast", cwd=folder)
    assert "12 of 12 frames shot, 0.50 s of clip" in done.stdout
    for said in (
        "12 frames, 1.2 s apart: 13.2 s of shooting",
        "6 of 12 frames",
        "GB free",
        "left  clip 0.25 of 0.50 s",
    ):
        assert said in done.stderr


def left_at(folder: Path, frame: int, number: signal.Signals) -> str:
    """A shoot in real time that gets a signal once so many frames are shot; what it says."""
    with running("play", "dusk.yaml", cwd=folder) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith(f"{frame} of 12 frames"):
                break
        second = teleop("play", "dusk.yaml", "--resume", cwd=folder)
        assert (second.returncode, second.stdout) == (2, "")
        assert second.stderr == "teleop: dusk.journal: another teleop is shooting with this journal\n"
        process.send_signal(number)
        said, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == (130 if number is signal.SIGINT else -number)
    return said


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_a_shoot_goes_on_where_a_signal_left_it_and_only_the_same_shoot_does(
    folder: Path, number: signal.Signals
) -> None:
    said = left_at(folder, 2, number)
    if number is signal.SIGINT:
        assert "Continue with --resume: frame " in said
    again = teleop("play", "dusk.yaml", "--fast", cwd=folder)
    assert again.returncode == 2
    assert "of 12: continue with --resume, or start over with --restart" in again.stderr
    (folder / "dusk.yaml").write_text(FILE.replace("pan: 10", "pan: 11"))
    changed = teleop("play", "dusk.yaml", "--fast", "--resume", cwd=folder)
    assert changed.returncode == 2
    assert "and dusk.yaml has changed since: restore it, or start over with --restart" in changed.stderr
    (folder / "dusk.yaml").write_text(FILE)
    report = shot(folder, "--resume", "--link", "gimbal=sim:")
    assert (report["shot"], report["lost"]) == (12, [])
    assert report["seconds"] < 11 * 1.2


def with_small_disk(folder: Path, kilobytes: int, command: str) -> subprocess.CompletedProcess[str]:
    """A shell command in `folder`, where `small` is a disk of so many kB that is empty at first."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or shutil.which("unshare") is None:
        pytest.skip("mounting a small disk needs root, and `unshare` (Debian: util-linux)")
    small = folder / "small"
    small.mkdir()
    script = f"mount -t tmpfs -o size={kilobytes}k none {small} && cd {folder} && {command}"
    arguments = ["unshare", "--mount", "sh", "-c", script]
    done = subprocess.run(arguments, capture_output=True, text=True, check=False, timeout=60)
    if "permission denied" in done.stderr.lower() or "not permitted" in done.stderr.lower():
        pytest.skip(f"mounting is not permitted here: {done.stderr.strip()}")
    return done


def test_a_full_disk_stops_the_shoot_before_the_frame_that_it_cannot_note(folder: Path) -> None:
    done = with_small_disk(folder, 72, f"cd small && exec {TELEOP} play ../dusk.yaml --fast --json")
    assert done.returncode == 1, done.stderr
    report = json.loads(done.stdout)
    assert "dusk.journal cannot be written: " in report["reasons"][0]
    assert report["reasons"][0].endswith(" was not shot")
    assert 0 < report["shot"] < 12


def test_a_take_that_cannot_be_written_is_said_and_every_frame_is_shot(folder: Path) -> None:
    done = with_small_disk(folder, 8, f"exec {TELEOP} play dusk.yaml --fast --take small/dusk.mcap")
    assert done.returncode == 0, done.stderr
    assert "12 of 12 frames shot" in done.stdout
    assert "teleop: small/dusk.mcap: No space left on device: " in done.stderr


def test_a_take_of_a_shoot_says_what_its_link_counted(folder: Path) -> None:
    report = shot(folder, "--take", "dusk.mcap")
    info = json.loads(teleop("take", "info", "dusk.mcap", "--json", cwd=folder).stdout)
    assert info["links"] == report["links"]
    assert info["links"]["gimbal"]["frames_out"] > 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["dusk.yaml", "--speed", "50%"],
            "dusk.yaml is a timelapse: --speed, --trim and the options of passes need --rehearse",
        ),
        (["dusk.yaml", "--resume", "--restart"], "--resume and --restart do not go together"),
        (["reveal", "--resume"], "--resume: reveal is not a timelapse"),
        (["reveal", "--in-doubt", "skip"], "--in-doubt: reveal is not a timelapse"),
        (["dusk.yaml", "--resume", "--fast"], "--resume: no shoot to resume: no dusk.journal in "),
        (["dusk.yaml", "--rig", "./blind.yaml"], "Simulated rig has no camera to shoot with"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(folder: Path, arguments: list[str], said: str) -> None:
    blind = find("sim", "profiles", "rig")[0].read_text().replace("  - {type: camera, link: gimbal}\n", "")
    (folder / "blind.yaml").write_text(blind)
    done = teleop("play", *arguments, cwd=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not (folder / "dusk.journal").exists()


def test_a_rehearsal_takes_as_long_as_the_clip_and_shoots_nothing(folder: Path) -> None:
    done = teleop("play", "dusk.yaml", "--rehearse", "--fast", "--json", cwd=folder)
    report = json.loads(done.stdout)
    assert done.returncode == 0
    assert "shot" not in report
    assert not (folder / "dusk.journal").exists()


def test_the_shipped_timelapse_fits_its_rigs() -> None:
    for rig in ("sim", "rs2"):
        profile = load_profile(rig)
        found = load_timelapse("day-to-night", profile.limits, profile.name)
        assert found is not None
        assert found.warnings == []
        assert found.rehearsal().warnings == []
