"""Passes against the first: a row for each axis of each pass, and the same for programs."""

from __future__ import annotations

import json

import pytest

from teleop.cli.screens.repeatability_table import PassesReport
from teleop.core.axes import Axis
from teleop.monitors.repeatability import Difference, Repeatability


def compared() -> Repeatability:
    found, difference = Repeatability(lambda _time: None), Difference()
    difference.commanded.add(0.0)
    for error in (0.3, -0.4):
        difference.measured.add(error)
    found.passes[2] = {Axis.PAN: difference, Axis.FOCUS: Difference()}
    return found


def test_programs_get_every_pass_and_axis():
    ((name, passes),) = PassesReport(compared()).facts()
    assert name == "passes"
    (second,) = json.loads(json.dumps(passes))
    assert second["pass"] == 2
    measured = second["axes"]["pan"]["measured"]
    assert (measured["readings"], measured["rms"], measured["peak"]) == (2, pytest.approx(0.353553391), 0.4)


def test_people_get_a_table_with_units(capsys: pytest.CaptureFixture[str]):
    PassesReport(compared()).print()
    printed = capsys.readouterr().out
    row = next(line for line in printed.splitlines() if "pan" in line)
    assert [cell.strip() for cell in row.strip("│").split("│")] == [
        "2",
        "pan",
        "0.0000",
        "0.0000",
        "0.3536",
        "0.4000",
        "deg",
    ]
    assert "0..1" in next(line for line in printed.splitlines() if "focus" in line)


def test_of_a_single_pass_nothing_is_printed(capsys: pytest.CaptureFixture[str]):
    PassesReport(Repeatability(lambda _time: None)).print()
    assert capsys.readouterr().out == ""
