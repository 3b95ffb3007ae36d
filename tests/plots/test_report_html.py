"""The page and the drawing of a take: commanded, measured, error, actions and why it stopped."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_takes import write_take

from teleop.cli import run
from teleop.core.axes import Axis, State
from teleop.core.events import Action
from teleop.plots.downsample import MOST
from teleop.plots.report_html import curves, marks, page
from teleop.recording.reader import Take, read_take
from teleop.recording.report import report

PAN = Axis.PAN
HOSTILE = "</script><b>pan stalled"


def swing(time: float) -> State:
    return State(10 * math.sin(time), 10 * math.cos(time), -10 * math.sin(time))


@pytest.fixture
def take(tmp_path: Path) -> Take:
    return made(tmp_path / "t.mcap", 8.0)


def made(path: Path, seconds: float) -> Take:
    measured = {PAN: lambda time: swing(time).position - 0.25}
    acts = {100: [Action.RECORD], 790: [Action.STOP]}
    write_take(path, {PAN: swing}, seconds, measured=measured, acts=acts, result="failed", reasons=[HOSTILE])
    return read_take(path)


def drawn(take: Take) -> dict[str, Any]:
    text = page(take, report(take))
    assert text.count("</script>") == 3  # of the page: what the take says cannot end one
    found = re.search(r'id="move">(.*?)</script>', text, re.DOTALL)
    assert found
    return json.loads(found[1])


def test_the_page_has_commanded_measured_error_actions_and_why_it_stopped(take: Take) -> None:
    move = drawn(take)
    assert [each["name"] for each in move["quantities"]] == ["position", "error", "velocity", "acceleration"]
    assert move["cues"] == [{"at": 1.0, "name": "record"}, {"at": 8.0, "name": f"stop; ended: failed: {HOSTILE}"}]
    assert f"ended: failed: {HOSTILE}" in move["facts"]
    (pan,) = move["axes"]
    samples = pan["samples"]
    index = pan["times"].index(4.0)
    assert samples["position"][index] == pytest.approx(swing(4).position, abs=1e-4)
    assert samples["measured"][index] == pytest.approx(swing(4).position - 0.25, abs=1e-4)
    assert (samples["error"][index], pan["peaks"]["error"]) == (pytest.approx(0.25, abs=1e-4), [pytest.approx(0.25)])
    assert len({len(row) for row in [pan["times"], *samples.values()]}) == 1


def test_nothing_is_drawn_where_nothing_was_measured(tmp_path: Path) -> None:
    take = read_take(write_take(tmp_path / "t.mcap", {PAN: swing}, 2.0))
    samples = drawn(take)["axes"][0]["samples"]
    assert set(samples["measured"]) == set(samples["error"]) == {None}
    assert None not in samples["position"]


def test_a_long_take_is_few_points_with_every_peak(tmp_path: Path) -> None:
    take = made(tmp_path / "t.mcap", 90.0)
    times, rows = curves(take, PAN)
    assert len(times) <= MOST < len(take.times)
    assert np.nanmax(rows[0]) == pytest.approx(take.motion[PAN][0].max())
    assert np.nanmin(rows[0]) == pytest.approx(take.motion[PAN][0].min())


def test_a_run_with_much_to_say_is_cut_short_at_its_mark(tmp_path: Path) -> None:
    path = write_take(tmp_path / "t.mcap", {PAN: swing}, 1.0, result="failed", reasons=["x" * 500])
    ((time, name),) = marks(read_take(path))
    assert (time, len(name) < 100) == (1.0, True)


@pytest.mark.parametrize(("name", "begins"), [("r.html", b"<!doctype"), ("r.svg", b"<?xml"), ("r.png", b"\x89PNG")])
def test_the_command_draws_what_the_ending_says(
    name: str, begins: bytes, take: Take, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(take.path.parent)
    assert run(["take", "report", "t.mcap", "-o", name]) == 0
    assert Path(name).read_bytes().startswith(begins)
    assert run(["take", "report", "t.mcap", "-o", name]) == 2
    assert capsys.readouterr().err == f"teleop: -o {name}: already exists; give --overwrite to replace it\n"
    assert run(["take", "report", "t.mcap", "-o", "r.pdf"]) == 2
    assert "its ending must be one of .html, .svg, .png" in capsys.readouterr().err
