"""`teleop take certificate`: passes against the plan and the first, and the measured path beside the page."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from made_takes import LIMITS, PERIOD, STARTED, write_take

from teleop.cli import run
from teleop.core.axes import Axis, Reading, State
from teleop.core.events import Tick
from teleop.recording.format import About, TakeWriter
from teleop.recording.played import Played, SequenceFacts

KEYS = {Axis.PAN: [0.0, 1.0, 2.0]}
EVERY = 2.6  # s from pass to pass
FACTS = SequenceFacts("ab" * 32, KEYS)


def passes_take(path: Path, errors: list[float], facts: SequenceFacts = FACTS, rig: str = "Bench") -> Path:
    """Passes of 2 s, 0.6 s apart, at 10 deg/s; each was measured so many degrees below the plan."""
    with path.open("wb") as stream:
        writer = TakeWriter(stream, About(rig, "Shot", STARTED, {Axis.PAN: LIMITS, Axis.TILT: LIMITS}, "0", facts))
        for tick in range(round(EVERY / PERIOD) * len(errors)):
            time = tick * PERIOD
            number, ticks = divmod(tick, round(EVERY / PERIOD))
            place = ticks * PERIOD
            playing = place <= 2.0 + 1e-9
            position = 10 * min(place, 2.0)
            reading = {Axis.PAN: Reading(position - errors[number], time)} if tick % 4 == 0 else {}
            motion = {Axis.PAN: State(position), Axis.TILT: State(0.0)}
            played = Played((number + 1, place) if playing else None, {}, {"gimbal": "1.2.3.4"})
            writer.add(Tick(time, motion, {}, (), reading), played)
        writer.end("done", [], 0)
    return path


def certified(capsys: pytest.CaptureFixture[str], page: Path, *takes: Path) -> dict[str, Any]:
    assert run(["take", "certificate", *map(str, takes), "-o", str(page), "--fps", "25", "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_each_pass_is_compared_with_the_plan_and_with_the_first(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    take = passes_take(tmp_path / "a.mcap", [0.1, -0.2])
    found = certified(capsys, tmp_path / "c.html", take)
    first, second = (each["axes"]["pan"] for each in found["passes"])
    assert first["first"] is None
    assert [first["plan"][each]["rms"] for each in ("all", "keys", "between")] == pytest.approx([0.1] * 3)
    assert [second["plan"][each]["peak"] for each in ("all", "keys", "between")] == pytest.approx([0.2] * 3)
    assert second["first"]["all"]["rms"] == pytest.approx(0.3)
    assert second["plan"]["keys"]["count"] == 3
    assert (found["firmware"], found["sequence"], found["not_measured"]) == ({"gimbal": "1.2.3.4"}, "ab" * 32, ["tilt"])


def test_a_file_for_each_pass_gives_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    both = certified(capsys, tmp_path / "c.html", passes_take(tmp_path / "a.mcap", [0.1, -0.2]))
    takes = [passes_take(tmp_path / f"{number}.mcap", [error]) for number, error in enumerate([0.1, -0.2])]
    each = certified(capsys, tmp_path / "d.html", *takes)
    mine, theirs = ([of["axes"]["pan"] for of in found["passes"]] for found in (both, each))
    for number, part in ((0, "plan"), (1, "plan"), (1, "first")):
        spread, other = (found[number][part]["all"] for found in (mine, theirs))
        assert spread["count"] == other["count"]
        assert (spread["rms"], spread["peak"]) == pytest.approx((other["rms"], other["peak"]))
    assert [Path(of["take"]).name for of in each["passes"]] == ["0.mcap", "1.mcap"]


def test_the_path_is_beside_the_page_as_chan_and_csv(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    found = certified(capsys, tmp_path / "c.html", passes_take(tmp_path / "a.mcap", [0.5]))
    page, chan, table = map(Path, found["written"])
    assert (chan.name, table.name) == ("c.pass1.ZXY.chan", "c.pass1.csv")
    lines = [line.split() for line in chan.read_text().splitlines()]
    assert [int(line[0]) for line in lines] == list(range(1, 52))  # 2 s at 25 frames a second, both ends
    assert {len(line) for line in lines} == {8}
    assert [float(line[5]) for line in lines] == pytest.approx([0.5 - 0.4 * frame for frame in range(51)], abs=1e-3)
    with table.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert float(rows[10]["pan_planned"]) - float(rows[10]["pan_measured"]) == pytest.approx(0.5, abs=1e-3)
    text = page.read_text()
    assert all(part in text for part in ("1.2.3.4", "ab" * 32, "Bench", "rotation order ZXY", chan.name, table.name))
    assert "Not measured, so nothing is certified of it: tilt." in text
    assert "<script" not in text
    assert "http" not in text.replace("http-equiv", "")


def test_what_a_take_does_not_have_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    old = write_take(
        tmp_path / "old.mcap", {Axis.PAN: lambda time: State(5 * time)}, 2.0, measured={Axis.PAN: lambda time: 5 * time}
    )
    found = certified(capsys, tmp_path / "c.html", old)
    assert (found["firmware"], found["sequence"]) == (None, None)
    assert "does not say where its passes begin" in found["passes"][0]["remarks"][0]
    assert found["passes"][0]["axes"]["pan"]["plan"]["keys"] is None
    text = (tmp_path / "c.html").read_text()
    assert text.count("not in the take") >= 2
    assert "the takes do not have the times of the keys" in text


def test_takes_of_other_moves_or_rigs_and_without_readings_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    one = passes_take(tmp_path / "a.mcap", [0.1])
    other = passes_take(tmp_path / "b.mcap", [0.1], SequenceFacts("cd" * 32, KEYS))
    far = passes_take(tmp_path / "f.mcap", [0.1], FACTS, "Elsewhere")
    silent = write_take(tmp_path / "s.mcap", {Axis.PAN: lambda _time: State(1.0)}, 1.0)
    for takes, reason in (
        ([one, other], "plays another move"),
        ([one, far], "was played on Elsewhere"),
        ([silent], "no axis was measured"),
    ):
        assert run(["take", "certificate", *map(str, takes), "-o", str(tmp_path / "n.html")]) != 0
        assert reason in capsys.readouterr().err
    assert not (tmp_path / "n.html").exists()


def test_nothing_is_replaced_unless_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    take = passes_take(tmp_path / "a.mcap", [0.1])
    (tmp_path / "c.pass1.csv").write_text("mine")
    arguments = ["take", "certificate", str(take), "-o", str(tmp_path / "c.html")]
    assert run(arguments) == 2
    assert "c.pass1.csv: already exists" in capsys.readouterr().err
    assert not (tmp_path / "c.html").exists()
    assert run([*arguments, "--overwrite"]) == 0
    assert run(["take", "certificate", str(take), "-o", str(tmp_path / "c.pdf")]) == 2
