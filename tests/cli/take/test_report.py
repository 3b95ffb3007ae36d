"""`teleop take report`: a table for people, an object for programs, a page where one is asked for."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from made_takes import at_rest, write_take

from teleop.cli import run
from teleop.cli.take.report import _plain
from teleop.core.axes import Axis


@pytest.fixture
def take(tmp_path: Path) -> Path:
    return write_take(
        tmp_path / "a.mcap",
        {Axis.PAN: at_rest(1.0)},
        2.0,
        measured={Axis.PAN: lambda _time: 0.75},
        reasons=["a reason"],
    )


def test_the_error_and_the_end_are_shown(take: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "report", str(take)]) == 0
    printed = capsys.readouterr().out
    assert "0.250" in next(line for line in printed.splitlines() if "pan" in line)
    assert "pan: delay unknown: " in printed
    assert "a reason" in printed.splitlines()[-1]


def test_programs_get_null_where_there_is_no_number(take: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "report", str(take), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["ok"], found["reasons"], found["axes"]["pan"]["rms"]) == (True, ["a reason"], 0.25)
    assert found["axes"]["pan"]["delay"] is None
    assert _plain(float("nan")) is None
    assert _plain(1 / 3) == 0.333333


def test_a_page_is_written_and_never_over_another_file(take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    page = tmp_path / "a.html"
    assert run(["take", "report", str(take), "-o", str(page)]) == 0
    assert page.read_text().startswith("<!")
    assert run(["take", "report", str(take), "-o", str(page)]) == 2
    assert run(["take", "report", str(take), "-o", str(tmp_path / "a.pdf")]) == 2
    assert "must be one of .html, .svg, .png" in capsys.readouterr().err
