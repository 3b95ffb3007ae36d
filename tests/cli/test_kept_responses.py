"""What one run finds of how the axes answer, and the next one uses: through the real commands, on simulated gimbals."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import teleop
from teleop.app.kept_responses import KeptResponses
from teleop.cli import run
from teleop.cli.doctor.finding import State
from teleop.cli.doctor.responses import responses
from teleop.config.profile import load_profile
from teleop.config.response_store import Key, ResponseStore, default_folder
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.response import Response
from teleop.devices.rig import open_rig
from teleop.sim.gimbal.device import SimulatedGimbal

PROFILE = """\
name: Late
links: {gimbal: "sim:"}
axes:
  pan: {min: -180, max: 180, velocity: 90, acceleration: 180, jerk: 900}
  tilt: {min: -56, max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, simulated: {lag: 0.1, dead_time: 0.05, gain: 0.92, drift: 0.5}}]
"""  # noqa: E501
MOVE = """\
title: swing
keyframes:
  - {at: 0s, pan: 0}
  - {at: 2s, pan: 45}
  - {at: 5s, pan: -20}
"""


@pytest.fixture
def play(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., Any]:
    """Plays the move on the rig, with parts of its profile replaced; with --json what it reports, else its text."""
    (tmp_path / "move.yaml").write_text(MOVE)

    def played(*replaced: tuple[str, str], text: bool = False) -> Any:
        profile = PROFILE
        for old, new in replaced:
            assert old in profile
            profile = profile.replace(old, new)
        (tmp_path / "rig.yaml").write_text(profile)
        capsys.readouterr()
        options = [] if text else ["--json"]
        assert run(["play", str(tmp_path / "move.yaml"), "--rig", str(tmp_path / "rig.yaml"), "--fast", *options]) == 0
        output = capsys.readouterr()
        return output if text else json.loads(output.out)

    return played


def error(report: Any) -> float:
    return report["axes"]["pan"]["rms"]


def kept_files() -> list[Path]:
    return sorted(Path(os.environ["XDG_STATE_HOME"]).rglob("*.json"))


def kept_keys() -> list[tuple[str, ...]]:
    """Each key with its axis."""
    return [(*each.key, each.axis.value) for each in ResponseStore(default_folder()).read()]


def test_the_second_run_is_better_than_the_first(play: Callable[..., Any]) -> None:
    first = play()
    found = first["responses"]["pan"]
    assert found["kept"]
    assert found["delay"] == pytest.approx(0.15, abs=0.015)
    assert found["gain"] == pytest.approx(0.92, abs=0.02)
    assert found["profile_delay"] is None
    second = play()
    assert error(second) < 0.7 * error(first)
    assert second["axes"]["pan"]["peak"] <= 0.3


@pytest.mark.parametrize(
    "other",
    [
        ("rate: 50,", "rate: 50, payload: a7,"),
        ("mode: speed", "mode: stick, full_stick: {pan: 120}"),
        ("name: Late", "name: Another"),
    ],
)
def test_another_payload_mode_or_rig_does_not_share(other: tuple[str, str], play: Callable[..., Any]) -> None:
    alone = error(play(other))
    run(["forget"])
    play()
    assert error(play(other)) == alone
    assert error(play(other)) < alone


def test_another_version_drops_what_was_kept_with_a_line(
    play: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    play()
    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", partial(SimulatedGimbal, version="03.00.00.01"))
    lines = [line for line in play(text=True).err.splitlines() if "dropped" in line]
    assert lines == [
        "teleop: gimbal: firmware 03.00.00.01, but how pan answers was found with firmware 02.02.00.07: dropped"
    ]
    assert [version for _, version, *_ in kept_keys()] == ["02.02.00.07", "03.00.00.01"]
    assert "dropped" not in play(text=True).err


def test_a_gimbal_that_has_changed_is_noticed_and_identified_anew(play: Callable[..., Any]) -> None:
    play()
    other = ("lag: 0.1, dead_time: 0.05", "lag: 0.2, dead_time: 0.1")
    assert "pan answers otherwise than before: it is identified anew" in play(other, text=True).err
    (kept,) = ResponseStore(default_folder()).read()
    assert kept.response.delay == pytest.approx(0.3, abs=0.015)


def test_a_change_that_is_not_found_anew_clears_what_was_kept(tmp_path: Path) -> None:
    """By a run that ends too early for it; what was not looked at stays."""
    path = tmp_path / "rig.yaml"
    path.write_text(PROFILE)
    profile = load_profile(str(path))
    store, key = ResponseStore(default_folder()), Key("Late", "", "sim", "speed", "")
    for axis in (Axis.PAN, Axis.TILT):
        store.keep(key, axis, Response(0.05, 0.1, 1.0, 0.0, 0.01, 0.01, 0.1))
    kept = KeptResponses(profile, pytest.fail)
    assert set(kept.priors) == {Axis.PAN, Axis.TILT}
    with open_rig(profile, VirtualClock(), priors=kept.priors) as rig:
        kept.begin(rig, pytest.fail)
        (device,) = rig.devices
        assert device.control is not None
        device.control.changed.add(Axis.PAN)
        assert kept.finish().kept == []
    assert [each.axis for each in store.read()] == [Axis.TILT]


def test_live_keeps_what_it_finds_and_a_run_that_moves_nothing_keeps_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "rig.yaml").write_text(PROFILE)
    sticks = tmp_path / "sticks.csv"
    for deflection, axes in ((0.0, []), (0.5, ["pan"])):
        sticks.write_text(f"time,pan\n0,0\n0.5,{deflection}\n2,{-deflection}\n3,0\n4,0\n")
        assert run(["live", "--sticks", str(sticks), "--rig", str(tmp_path / "rig.yaml"), "--fast", "--json"]) == 0
        assert list(json.loads(capsys.readouterr().out)["responses"]) == axes
        assert [axis for *_, axis in kept_keys()] == axes


def test_the_end_of_a_run_has_a_line_for_each_axis_that_was_identified(play: Callable[..., Any]) -> None:
    (line,) = [line for line in play(text=True).out.splitlines() if "answers" in line]
    assert line.startswith("pan answers 0.15 s late (doubt 0.0")
    assert ", gain 0.92, drift 0.5 deg/s" in line
    assert line.endswith("; kept for the next run")


def test_the_delay_of_the_profile_overrides_what_is_found(play: Callable[..., Any]) -> None:
    assert play(("rate: 50,", "rate: 50, delay: 0.15,"))["responses"]["pan"]["profile_delay"] == 0.15
    output = play(("rate: 50,", "rate: 50, delay: 0.15,"), text=True).out
    assert "; the profile's delay of 0.15 s counts" in output


def test_doctor_shows_what_is_kept_and_forget_clears_it(
    play: Callable[..., Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    play(("rate: 50,", "rate: 50, payload: fx3-24mm,"))
    assert kept_keys() == [("Late", "02.02.00.07", "sim", "speed", "fx3-24mm", "pan")]
    assert run(["doctor", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    (kept,) = report["responses"]
    assert {name: kept[name] for name in ("rig", "link", "mode", "payload", "axis")} == {
        "rig": "Late",
        "link": "sim",
        "mode": "speed",
        "payload": "fx3-24mm",
        "axis": "pan",
    }
    assert kept["delay"] == pytest.approx(0.15, abs=0.015)
    (line,) = [each["found"] for each in report["findings"] if each["about"] == "response"]
    assert line.startswith("Late, mode speed on sim, fx3-24mm, firmware 02.02.00.07: pan 0.15 s late")
    assert run(["forget", "--rig", "sim"]) == 0
    assert capsys.readouterr().out == "nothing is kept of Simulated rig\n"
    assert run(["forget", "--rig", str(tmp_path / "rig.yaml")]) == 0
    assert capsys.readouterr().out == "cleared: Late, mode speed on sim, fx3-24mm, firmware 02.02.00.07: pan\n"
    assert kept_files() == []
    play()
    assert run(["forget", "--all", "--json"]) == 0
    assert [each["axis"] for each in json.loads(capsys.readouterr().out)["cleared"]] == ["pan"]
    assert kept_files() == []


def test_a_damaged_file_is_a_warning_and_stays(play: Callable[..., Any], capsys: pytest.CaptureFixture[str]) -> None:
    first = play()
    (path,) = kept_files()
    path.write_text("{")
    assert not play()["responses"]["pan"]["kept"]
    output = play(text=True)
    assert [line for line in output.err.splitlines() if "damaged" in line] == [
        f"teleop: warning: {path}: damaged, not used and not replaced: clear it with teleop forget"
    ]
    assert path.read_text() == "{"
    (finding,) = responses()
    assert finding.state is State.PROBLEM
    assert (finding.found, finding.todo) == (
        f"{path}: damaged, not used and not replaced",
        "clear it with teleop forget",
    )
    assert run(["forget", "--rig", "Late"]) == 0
    assert capsys.readouterr().out == f"cleared: {path}, which was damaged\n"
    assert error(play()) == error(first)


def test_position_mode_finds_how_late_it_is_and_goes_by_nothing_of_it(play: Callable[..., Any]) -> None:
    late = ("mode: speed", "mode: position"), ("lag: 0.1,", "position_lag: 0.08,")
    first, second = play(*late), play(*late)
    found = first["responses"]["pan"]
    assert found["delay"] == pytest.approx(0.13, abs=0.02)
    assert found["kept"]
    assert found["drift_doubt"] is None
    assert second["axes"] == first["axes"]
    line = "pan is 0.13 s late: the profile can make up for it, with delay: 0.13"
    assert line in play(*late, text=True).out
    (kept,) = [finding for finding in responses() if finding.state is State.OK]
    assert "pan 0.13 s late (doubt 0." in kept.found
    assert "drift" not in kept.found, "nothing is known of it"


def test_position_mode_on_time_has_no_line(play: Callable[..., Any]) -> None:
    prompt = ("mode: speed", "mode: position"), ("dead_time: 0.05", "dead_time: 0.0")
    assert "late" not in play(*prompt, text=True).out


def test_a_folder_that_cannot_be_written_costs_a_line_and_no_run(
    play: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    assert "how pan answers is not kept: " in play(text=True).err


def test_a_program_on_the_virtual_clock_sees_responses_and_keeps_none(tmp_path: Path) -> None:
    path = tmp_path / "rig.yaml"
    path.write_text(PROFILE)
    with teleop.open(path, virtual=True) as rig:
        assert rig.responses() == {}
        rig.move(pan=40)
        assert rig.responses()["pan"].delay == pytest.approx(0.15, abs=0.02)
    assert kept_files() == []
