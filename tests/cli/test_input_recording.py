"""`teleop live --input-recording`: recorded devices, read by the code that reads real ones, on the virtual clock."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from command import teleop

RECORDINGS = Path(__file__).parents[1] / "data" / "hid-recordings"
CASES: Mapping[str, Any] = json.loads((RECORDINGS / "cases.json").read_text())
RIG = (Path(__file__).parents[2] / "profiles" / "sim.yaml").read_text()


def commanded(folder: Path, recordings: Sequence[Path], profile: str = "") -> list[dict[str, str]]:
    """The rows of the take of these recordings on the simulated rig."""
    folder.mkdir(exist_ok=True)
    (folder / "rig.yaml").write_text(RIG + profile)
    devices = [word for file in recordings for word in ("--input-recording", str(file))]
    own = ["--rig", str(folder / "rig.yaml"), "--presets", str(folder / "presets.yaml")]
    ran = teleop("live", *own, "--fast", "--take", str(folder / "run.mcap"), *devices)
    assert ran.returncode == 0, ran.stderr
    assert teleop("take", "export", str(folder / "run.mcap"), "--csv", str(folder / "run.csv")).returncode == 0
    with (folder / "run.csv").open(newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("name", CASES)
def test_what_must_come_of_each_case(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    rows = commanded(tmp_path, [RECORDINGS / file for file in case["recordings"]], case["profile"])
    for expected in case["expect"]:
        axis = expected["axis"]
        at = min((row for row in rows if row[axis]), key=lambda row: abs(float(row["time"]) - expected["time"]))
        assert expected["low"] <= float(at[axis]) <= expected["high"], (case["why"], at)


def test_the_same_recording_gives_the_same_motion_bit_for_bit(tmp_path: Path) -> None:
    file = [RECORDINGS / "keyboard-mouse-gamepad.jsonl"]
    assert commanded(tmp_path / "one", file) == commanded(tmp_path / "two", file)


def recording(file: Path, rows: Sequence[tuple[float, str | None]], **device: Any) -> Path:
    """An F310 with these reports, None for an unplugging and "" for a plugging in."""
    identity = {"name": "Logitech F310", "vendor": "046d", "product": "c216", "serial": "", "interface": 0}
    first = json.loads((RECORDINGS / "steady-at-the-stop.jsonl").read_text().splitlines()[0])
    lines: list[Mapping[str, Any]] = [{**first, "device": {**identity, "usages": [[1, 4]], **device}}]
    for time, report in rows:
        what = {"unplugged": True} if report is None else {"report": report} if report else {"plugged": True}
        lines.append({"time": round(time, 3), **what})
    file.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return file


def held(value: str, begin: float, end: float) -> list[tuple[float, str | None]]:
    """A report each 10 ms with X at this value, in hexadecimal."""
    return [(begin + index / 100, f"{value}7f7f7f08000000") for index in range(round((end - begin) * 100))]


def test_a_recorded_device_is_unplugged_in_mid_pan_and_comes_back(tmp_path: Path) -> None:
    back = [*held("ff", 4, 6), *held("7f", 6, 7), *held("ff", 7, 8), *held("7f", 8, 9)]
    rows = [*held("7f", 0, 1), *held("ff", 1, 2), (2.0, None), (4.0, ""), *back]
    ticks = commanded(tmp_path, [recording(tmp_path / "pad.jsonl", rows)])
    pan = {round(float(row["time"]), 2): float(row["pan"]) for row in ticks if row["pan"]}
    assert pan[2.0] > 5
    assert pan[3.5] == pytest.approx(pan[6.9]), "unplugged, and then held while it is plugged in: it is locked"
    assert pan[8.0] > pan[7.0] + 5, "after it was centered it moves the rig again"


def test_of_a_receivers_interfaces_the_one_that_reports_is_read(tmp_path: Path) -> None:
    rows = [*held("7f", 0, 1), *held("ff", 1, 2), *held("7f", 2, 3)]
    silent = recording(tmp_path / "silent.jsonl", [], serial="A", interface=0)
    pad = recording(tmp_path / "pad.jsonl", rows, serial="A", interface=1)
    assert float(commanded(tmp_path, [silent, pad])[-1]["pan"]) > 5


@pytest.mark.parametrize("key", [{"serial": "B"}, {"port": "1-3"}])
def test_devices_of_one_model_are_told_apart(tmp_path: Path, key: dict[str, str]) -> None:
    name = next(iter(key))
    still = recording(tmp_path / "still.jsonl", held("7f", 0, 3), **{name: "A"})
    pushed = recording(tmp_path / "pushed.jsonl", [*held("7f", 0, 1), *held("ff", 1, 3)], **key)
    profile = f"inputs:\n  - device: {{{name}: {key[name]}}}\n    controls: {{X: {{axis: tilt}}}}\n"
    last = commanded(tmp_path, [still, pushed], profile)[-1]
    assert (float(last["tilt"]) > 5, float(last["pan"])) == (True, 0)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", ":1: the file is empty"),
        ("{}\n", ':1: the first line needs a "device"'),
        ('{"device": {"vendor": "046d", "product": "c216"}, "descriptor": "05z"}\n', ':1: "descriptor" must be hexa'),
        (
            '{"device": {"vendor": "046d", "product": "c216"}, "descriptor": "05"}\n{"time": -1, "report": "00"}\n',
            ':2: "time" must be 0 s or later',
        ),
    ],
)
def test_what_is_wrong_with_a_recording_is_one_line_with_its_place(tmp_path: Path, text: str, problem: str) -> None:
    (tmp_path / "pad.jsonl").write_text(text)
    ran = teleop("live", "--fast", "--input-recording", str(tmp_path / "pad.jsonl"))
    assert ran.returncode == 2
    assert f"pad.jsonl{problem}" in ran.stderr
    assert "Traceback" not in ran.stderr
