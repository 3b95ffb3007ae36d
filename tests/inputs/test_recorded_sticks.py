"""Recorded sticks: files that are refused with the line, and what is held when."""

import math
from pathlib import Path

import pytest
from fakes import NO_FEEDBACK

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis, State
from teleop.core.setpoints import VelocityTarget
from teleop.inputs.recorded_sticks import MAX_PROBLEMS, SticksSource, read_sticks

KNOWN = [Axis.PAN, Axis.TILT]


def written(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "sticks.csv"
    file.write_text(text)
    return file


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", ":1: the file is empty"),
        ("pan\n1\n", ":1: there is no column called time"),
        ("time\n1\n", ":1: no column names an axis"),
        ("time,pna\n0,1\n", ":1: 'pna' is not an axis of this rig; did you mean pan?"),
        ("time,pan,pan\n0,1,1\n", ":1: duplicate column pan"),
        ("time,pan\n", ":1: there are no rows"),
        ("time,pan\n0,1.5\n", ":2: pan must be -1..1, not 1.5"),
        ("time,pan\n0,nan\n", ":2: pan must be -1..1, not nan"),
        ("time,pan\n0,1\n\n0,0\n", ":4: time must be after the row before it (0 s)"),
        ("time,pan\n-1,0\n", ":2: time must be 0 s or later, not -1"),
        ("time,pan\n0\n", ":2: has 1 values for 2 columns"),
        ("time,pan\n0,left\n", ":2: pan must be a number, not 'left'"),
    ],
)
def test_a_bad_file_is_refused_with_its_line(tmp_path: Path, text: str, problem: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read_sticks(written(tmp_path, text), KNOWN)
    assert any(problem in line for line in caught.value.problems), caught.value.problems


def test_errors_come_all_at_once_but_not_without_end(tmp_path: Path) -> None:
    with pytest.raises(DocumentError) as caught:
        read_sticks(written(tmp_path, "time,pan\n" + "0,9\n" * 100), KNOWN)
    assert len(caught.value.problems) == MAX_PROBLEMS + 1
    assert caught.value.problems[-1].endswith("and 80 more")


def test_deflections_hold_between_rows_and_end_with_the_last(tmp_path: Path) -> None:
    sticks = read_sticks(written(tmp_path, "time, pan, tilt\n1,0.5,0\n2,-1,1\n3,1,1\n"), KNOWN)
    source = SticksSource(sticks, lambda axis, deflection: 100 * deflection)
    source.start(10.0, {Axis.PAN: State(0), Axis.TILT: State(0)})
    assert source.read(10.5, NO_FEEDBACK) == ({}, ())
    assert source.next_change(10.5) == 11.0
    assert source.read(11.0, NO_FEEDBACK)[0] == {Axis.PAN: VelocityTarget(50)}  # a centred stick has no opinion
    assert source.read(11.99, NO_FEEDBACK)[0] == {Axis.PAN: VelocityTarget(50)}
    assert source.read(12.0, NO_FEEDBACK)[0] == {Axis.PAN: VelocityTarget(-100), Axis.TILT: VelocityTarget(100)}
    assert source.next_change(12.0) == 13.0
    assert source.read(13.0, NO_FEEDBACK) == ({}, ())  # the last row ends it
    assert math.isinf(source.next_change(13.0))
