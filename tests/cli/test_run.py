"""`teleop` as typed: exit codes, errors of one line, reports, and two real processes on a real bus."""

from __future__ import annotations

import json
import math
import re
import signal
import socket
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from command import running, teleop
from network import own_network
from waiting import DEADLINE

from sequences import RIGS
from teleop.config.resources import folder

BUS = "gimbal=udp_multicast:239.74.163.2"
STICKS = "time,pan\n0,0.3\n1,0\n2,0\n"


def test_the_demo_plays_and_reports_every_axis() -> None:
    done = teleop("play", "reveal", "--fast")
    assert done.returncode == 0, done.stderr
    for word in ("pan", "tilt", "focus", "RMS error", "Peak error"):
        assert word in done.stdout
    assert " / 15.0 s" in done.stderr


SHIPPED = [file.stem for file in sorted(folder("sequences").glob("*.yaml"))]
ASKED = {  # of some: ten minutes, and an evening, are only looked at in short
    "interview": ["--start-at", "570s"],
    "day-to-night": ["--rehearse"],
    "fly-by": ["--i-understand"],
}


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_move_plays_to_its_end(name: str) -> None:
    done = teleop("play", name, "--fast", "--json", "--rig", RIGS.get(name, "sim"), *ASKED.get(name, []))
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["result"] == "done"
    for score in report["axes"].values():
        assert score["rms"] < 0.1


def test_every_shipped_move_stands_in_their_readme() -> None:
    readme = (folder("sequences") / "README.md").read_text()
    assert sorted(re.findall(r"^\| \[`(.+)`\]\(\1\.yaml\) \|", readme, re.MULTILINE)) == SHIPPED


def test_json_is_one_object_for_programs() -> None:
    done = teleop("play", "reveal", "--fast", "--json")
    report = json.loads(done.stdout)
    assert (done.returncode, done.stderr) == (0, "")
    assert (report["result"], report["reasons"]) == ("done", [])
    assert report["seconds"] > 15
    assert set(report["axes"]) == {"pan", "tilt", "focus"}
    assert report["axes"]["pan"]["rms"] < 0.1
    assert report["links"]["gimbal"]["replies"] > 100
    assert report["links"]["gimbal"]["lost_replies"] == 0


def test_check_promises_no_speed_that_play_refuses(tmp_path: Path) -> None:
    (tmp_path / "hard.yaml").write_text("keyframes: [{at: 0, pan: 0}, {at: 1.6, pan: 60}]\n")
    checked = json.loads(teleop("check", "hard.yaml", "--json", cwd=tmp_path).stdout)
    most = math.floor(100 * checked["speed_at_most"])
    assert 100 < most < 200
    assert teleop("play", "hard.yaml", "--fast", "--speed", f"{most}%", cwd=tmp_path).returncode == 0
    refused = teleop("play", "hard.yaml", "--fast", "--speed", f"{most + 1}%", cwd=tmp_path)
    assert refused.stderr == f"--speed {most + 1}%: maximum playback speed: {most} %, not {most + 1} %\n"
    assert "A drone's move is played at its own speed only." in teleop("check", "fly-by", "--rig", "sim-drone").stdout


def test_sticks_are_replayed(tmp_path: Path) -> None:
    (tmp_path / "sticks.csv").write_text(STICKS)
    done = teleop("live", "--sticks", str(tmp_path / "sticks.csv"), "--fast", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["axes"]["pan"]["readings"] > 20


def test_check_says_what_a_move_asks_and_opens_no_port() -> None:
    done = teleop("check", "reveal", "--rig", "rs2", "--link", "gimbal=slcan:/dev/nothing-here")
    assert done.returncode == 0, done.stderr
    assert "15.00 s on DJI RS 2" in done.stdout
    assert "Cues: record, stop." in done.stdout
    report = json.loads(teleop("check", "reveal", "--json").stdout)
    assert report["cues"] == [{"at": 0, "name": "record"}, {"at": 15, "name": "stop"}]
    assert report["duration"] == 15
    assert 0 < report["axes"]["pan"]["velocity"] < 1
    assert report["speed_at_most"] == 2, "that is what play goes to, whatever the axes could"
    assert report["axes"]["pan"]["room"] == pytest.approx(140, abs=0.01)


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["plai"], 2, 'Did you mean "play"?'),
        (["play", "reveal", "--rgi", "sim"], 2, "--rgi"),
        (["play", "reveal", "--speed", "500%"], 2, "--speed 500%: maximum playback speed: 200 %"),
        (["play", "reveal", "--speed", "fast"], 2, "--speed fast: must be a percentage above 0"),
        (["play", "revel"], 2, "did you mean reveal?"),
        (["play", "reveal", "--start-at", "key9"], 2, "--start-at key9: there is key1..key5"),
        (["play", "reveal", "--start-at", "20s"], 2, "--start-at 20s: the move ends at 15 s"),
        (["play", "reveal", "--start-at", "96f"], 2, "--start-at 96f: is 96f, in frames, which needs fps"),
        (["play", "reveal", "--trigger", "now"], 2, "--trigger now: must be key, osc:9000/go, mtc"),
        (["play", "reveal", "--trigger", "key"], 2, "--trigger key: there is no terminal"),
        (["play", "reveal", "--trigger", "time", "18:30", "--fast"], 2, "needs real time; leave out --fast"),
        (["play", "reveal", "--trim", "--fast"], 2, "--trim: an operator works in real time"),
        (["play", "reveal", "--trim-out", "x.yaml"], 2, "--trim-out: needs --trim"),
        (["play", "reveal", "--trim", "--trim-share", "100%"], 2, "must be a percentage between 0 and 100"),
        (["play", "reveal", "--preroll", "soon"], 2, "--preroll soon: must be a time"),
        (["play", "reveal", "--passes", "0"], 2, "--passes: must be at least 1"),
        (["play", "reveal", "--passes", "1.5"], 2, "--passes: It must be a whole number"),
        (["send", "angles", "--retries", "0.5"], 2, "--retries: It must be a whole number"),
        (["play", "reveal", "--passes", "3", "--loop"], 2, "--passes: leave out --loop"),
        (["play", "./nothing.yaml"], 2, "no such file"),
        (["play", "reveal", "--rig", "smi"], 2, "did you mean sim?"),
        (["play", "reveal", "--link", "gimbal"], 2, "write it as NAME=URL"),
        (["play", "reveal", "--link", "gimbal=scan:can0"], 2, "no interface 'scan'"),
        (["play", "reveal", "--fast", "--rig", "rs2"], 2, "only sim: links can be played fast"),
        (["play", "reveal", "--rig", "rs2", "--link", "gimbal=slcan:/dev/nothing-here"], 1, "/dev/nothing-here"),
        (["live", "--sticks", "nothing.csv"], 2, "nothing.csv: cannot be read"),
        (["sim"], 2, "--link gimbal="),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(arguments: list[str], code: int, said: str) -> None:
    done = teleop(*arguments)
    assert done.returncode == code, done.stderr
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert done.stdout == ""


def test_a_bad_file_says_everything_at_once_and_a_hard_move_is_another_failure(tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text("keyframes:\n  - {at: 0, pna: 1}\n  - {at: x, pan: 1}\n")
    bad = teleop("check", "bad.yaml", cwd=tmp_path)
    assert bad.returncode == 2
    assert [line.split(": ")[0] for line in bad.stderr.splitlines()] == [
        "bad.yaml:2:5",
        "bad.yaml:2:13",
        "bad.yaml:3:10",
    ]
    (tmp_path / "hard.yaml").write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 0.2, pan: 90}\n")
    for command in ("check", "play"):
        hard = teleop(command, "hard.yaml", cwd=tmp_path)
        assert hard.returncode == 1
        assert hard.stderr.startswith("hard.yaml:3:5: pan needs ")
    assert json.loads(teleop("check", "hard.yaml", "--json", cwd=tmp_path).stdout)["ok"] is False


def test_a_move_plays_at_another_speed() -> None:
    played = json.loads(teleop("play", "reveal", "--fast", "--speed", "150%", "--json").stdout)
    assert played["seconds"] == pytest.approx(10.0, abs=0.1)
    assert played["axes"]["pan"]["peak"] < 0.15


def test_what_a_sequence_tells_the_gimbal_is_told_and_its_answer_said(tmp_path: Path) -> None:
    (tmp_path / "told.yaml").write_text(
        "keyframes: [{at: 0, pan: 0}, {at: 2, pan: 5}]\n"
        "cues:\n  - {at: 0, follow: lock}\n  - {at: 2, send: gimbal stiffness}\n  - {at: 2, camera: focus}\n"
        "  - {at: 3, send: gimbal version}\n"
    )
    done = teleop("play", "told.yaml", "--fast", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for words in ("gimbal follow lock: done", "gimbal stiffness: done", "gimbal version: "):
        assert words in done.stderr


def test_passes_say_how_far_each_lay_from_the_first() -> None:
    played = teleop("play", "reveal", "--fast", "--passes", "3", "--preroll", "1s")
    assert played.returncode == 0, played.stderr
    assert "starts in" in played.stderr
    assert "pass 3 of 3" in played.stderr
    assert "Each pass against the first" in played.stdout
    report = json.loads(teleop("play", "reveal", "--fast", "--passes", "2", "--json").stdout)
    (second,) = report["passes"]
    assert second["pass"] == 2
    for axis in ("pan", "tilt", "focus"):
        assert second["axes"][axis]["commanded"]["peak"] < 1e-9
        assert second["axes"][axis]["measured"]["peak"] <= 0.1


def test_a_move_is_started_in_its_middle_and_goes_back_to_one() -> None:
    played = teleop("play", "reveal", "--fast", "--start-at", "key3", "--back-to-one")
    assert "run-up to 8.0 s" in played.stderr
    assert "back to one" in played.stderr
    assert [row for row in played.stdout.splitlines() if "pan" in row and "-30.000" in row]


def test_a_sequence_that_waits_for_somebody_needs_somebody(tmp_path: Path) -> None:
    (tmp_path / "wait.yaml").write_text(
        "keyframes: [{at: 0, pan: 0}, {at: 2, pan: 5}]\ncues: [{at: 2, wait: operator}]\n"
    )
    alone = teleop("play", "wait.yaml", cwd=tmp_path)
    assert alone.returncode == 2
    assert "wait.yaml waits for the operator at 2 s: run it on a terminal" in alone.stderr
    fast = teleop("play", "wait.yaml", "--fast", cwd=tmp_path)
    assert fast.returncode == 0
    assert "--fast: waits for the operator are skipped" in fast.stderr


def test_a_move_waits_in_place_for_its_trigger_and_starts_at_once(tmp_path: Path) -> None:
    (tmp_path / "short.yaml").write_text("keyframes: [{at: 0, pan: 0}, {at: 1, pan: 5}]\n")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.bind(("127.0.0.1", 0))
        port = sender.getsockname()[1]
    with running("play", str(tmp_path / "short.yaml"), "--trigger", f"osc:{port}/go") as process:
        wait_for(process, f"waiting for OSC /go on 127.0.0.1:{port}")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"nonsense", ("127.0.0.1", port))
            sender.sendto(b"/go\0,\0\0\0", ("127.0.0.1", port))
        out, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0
    assert "5.000" in out


def test_a_signal_ends_a_run_that_waits_for_its_trigger() -> None:
    later = f"{datetime.now() + timedelta(hours=6):%H:%M:%S}"
    with running("play", "reveal", "--trigger", "time", later) as process:
        wait_for(process, f"waiting for {later}")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=DEADLINE)
    assert process.returncode == 130


def test_debug_shows_where_an_error_came_from() -> None:
    assert "Traceback" not in teleop("play", "revel").stderr
    assert "Traceback" in teleop("play", "revel", "--debug").stderr


def wait_for(process, text: str) -> None:
    """Read stderr up to a line with `text`."""
    said: list[str] = []
    for line in process.stderr:
        if text in line:
            return
        said.append(line)
    pytest.fail(f"{text!r} never came: {' '.join(said)}")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_a_move_smoothly_and_soon(number: signal.Signals) -> None:
    with running("play", "reveal") as process:
        wait_for(process, " / 15.0 s")
        process.send_signal(number)
        process.send_signal(number)
        _, said = process.communicate(timeout=DEADLINE)
    assert process.returncode == 130
    assert f"stopped: {number.name} received" in said


def test_a_hang_up_that_its_starter_had_ignored_stops_nothing() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        with running("play", "reveal") as process:
            wait_for(process, " / 15.0 s")
            process.send_signal(signal.SIGHUP)
            wait_for(process, "   3.0 / 15.0 s")
            process.send_signal(signal.SIGTERM)
            _, said = process.communicate(timeout=DEADLINE)
    finally:
        signal.signal(signal.SIGHUP, before)
    assert "stopped: SIGTERM received" in said


@pytest.fixture(scope="module")
def bus() -> Iterator[str]:
    """A bus between processes, in a network namespace of its own."""
    with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
        yield BUS


def short_move(folder: Path) -> str:
    """On a real bus a move takes as long as it is."""
    (folder / "short.yaml").write_text("keyframes: [{at: 0, pan: 0}, {at: 2s, pan: 12}, {at: 4s, pan: 0}]")
    return str(folder / "short.yaml")


def test_two_processes_talk_over_a_real_bus(bus: str, tmp_path: Path) -> None:
    with running("sim", "--link", bus) as far:
        assert far.stdout is not None
        assert "simulated gimbal" in far.stdout.readline()
        done = teleop("play", short_move(tmp_path), "--link", bus, "--json")
        assert done.returncode == 0, f"{done.stdout} {done.stderr}"
        assert json.loads(done.stdout)["axes"]["pan"]["rms"] < 0.5
        far.send_signal(signal.SIGINT)
        far.communicate(timeout=DEADLINE)
        assert far.returncode == 130


def test_two_programs_on_one_bus_are_recognised(bus: str, tmp_path: Path) -> None:
    (tmp_path / "slow.yaml").write_text("keyframes: [{at: 0, pan: 0}, {at: 7s, pan: 12}]")
    with running("sim", "--link", bus) as far:
        assert far.stdout is not None
        far.stdout.readline()
        with (
            running("play", str(tmp_path / "slow.yaml"), "--link", bus, "--json") as one,
            running("calibrate", "delay", "--axis", "roll", "--link", bus) as other,
        ):
            out, said = one.communicate(timeout=60)
            other.send_signal(signal.SIGINT)
            other.communicate(timeout=60)
    assert "another program is driving this gimbal (link gimbal, udp_multicast:239.74.163.2)" in said
    assert json.loads(out)["links"]["gimbal"]["foreign_replies"] > 10


@pytest.mark.parametrize("mode", ["position", "speed"])
def test_a_gimbal_that_vanishes_ends_the_run_soon(bus: str, tmp_path: Path, mode: str) -> None:
    profile = (Path(__file__).parents[2] / "profiles" / "sim.yaml").read_text()
    (tmp_path / "rig.yaml").write_text(profile.replace("mode: position", f"mode: {mode}"))
    with running("sim", "--link", bus) as far:
        assert far.stdout is not None
        far.stdout.readline()
        with running("play", "reveal", "--rig", str(tmp_path / "rig.yaml"), "--link", bus) as process:
            wait_for(process, " / 15.0 s")
            far.kill()
            _, said = process.communicate(timeout=DEADLINE)
    assert process.returncode == 1
    assert "gimbal on udp_multicast:239.74.163.2 does not answer" in said


def test_nobody_on_the_bus_is_said_before_anything_moves(bus: str) -> None:
    done = teleop("play", "reveal", "--link", bus)
    assert done.returncode == 1
    assert "does not answer: is it on, is the cable in?" in done.stderr
