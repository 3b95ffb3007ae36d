"""`teleop commission --compare`, and the results of a commissioning, from the command line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from made_findings import FOUND, UPDATED

from teleop.app.commission.kept import Kept
from teleop.cli import run
from teleop.cli.commission_results import ResultOptions, tell_results
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.links import parse


@pytest.fixture
def reports(tmp_path: Path) -> tuple[Path, Path]:
    old, new = tmp_path / "old.json", tmp_path / "new.json"
    old.write_text(FOUND.to_json())
    new.write_text(UPDATED.to_json())
    return old, new


def test_two_reports_are_compared_without_a_device(
    reports: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = map(str, reports)
    assert run(["commission", "--compare", old, "--compare", new, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["changes"] == [
        "firmware: 03.01.00.10 -> 04.00.00.00",
        "Sign of pan in speed commands (0E 01): -1 -> 1",
        "A focus motor answers <0E 12>: not seen -> yes",
        "Limit of the gimbal: pitch max: 145 deg -> not seen",
    ]
    assert run(["commission", "--compare", old, "--compare", old]) == 0
    assert capsys.readouterr().out.splitlines()[-1].strip() == "nothing changed"


def test_reports_of_two_kinds_of_device_are_not_compared(
    reports: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    reports[1].write_text(replace(FOUND, device="drone").to_json())
    assert run(["commission", "--compare", str(reports[0]), "--compare", str(reports[1])]) == 2
    assert capsys.readouterr().err.endswith("old.json of a gimbal\n")


def test_one_report_is_compared_with_what_is_found_now(
    reports: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ResultOptions(tmp_path / "out", (reports[0],))
    with Kept(options.wanted, "rig", "gimbal", VirtualClock().now) as kept:
        kept.tapped(parse("sim:"))
        kept.write(UPDATED)
    tell_results(kept, UPDATED, options.compare)
    printed = capsys.readouterr()
    assert "Sign of pan in speed commands (0E 01): -1 -> 1" in printed.out
    assert "report.html, report.json" in " ".join(printed.out.split())
    assert kept.facts(UPDATED)["capture"].endswith("capture.log")
    assert "Changed since the earlier report" in (tmp_path / "out" / "report.html").read_text()


def test_a_report_that_cannot_be_compared_is_refused_before_anything_is_opened(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read"):
        Kept(ResultOptions(None, (tmp_path / "none.json",)).wanted, "rig", "gimbal", VirtualClock().now)


def test_where_nothing_was_found_nothing_is_written(tmp_path: Path) -> None:
    with Kept(ResultOptions(tmp_path / "out").wanted, "rig", "gimbal", VirtualClock().now) as kept:
        kept.tapped(parse("sim:"))
        kept.write(replace(FOUND, facts=()))
    assert not (tmp_path / "out").exists()
    assert kept.facts(FOUND) == {}
