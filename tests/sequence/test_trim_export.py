"""A trim written into the keys of a sequence: its text with other numbers and nothing else, or a reason why not."""

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.files import OutputError
from teleop.core.axes import Axis, Limits, State
from teleop.core.errors import UsageError
from teleop.sequence.compile import load_sequence
from teleop.sequence.trim_export import TrimmedFile

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-180, 180, 60, 120, 600), TILT: Limits(-56, 40, 60, 120, 600)}
TEXT = """# A comment that stays: pan 5
title: Shoot
keyframes:
  - {at: 0, pan: -30, tilt: 0.25}   # low
  - at: 4s
    pan: 1e1     # and here
    pass: stop
  - {at: 8, tilt: 39.9999, pan: 20}
cues: [{at: 0, camera: record}]
"""


def trimmed(tmp_path: Path, text: str, axes=(PAN, TILT)) -> TrimmedFile:
    (tmp_path / "shoot.yaml").write_bytes(text.encode())
    return TrimmedFile(str(tmp_path / "shoot.yaml"), tmp_path / "out.yaml", axes, LIMITS)


def test_only_the_numbers_of_the_keys_are_other_ones(tmp_path: Path):
    file = trimmed(tmp_path, TEXT)
    offsets = {PAN: State(2.34567), TILT: State(-0.25)}
    expected = TEXT.replace("pan: -30", "pan: -27.6543").replace("tilt: 0.25", "tilt: 0").replace("1e1", "12.3457")
    expected = expected.replace("39.9999", "39.7499").replace("pan: 20", "pan: 22.3457")
    assert file.text(offsets) == expected
    file.write(offsets)
    assert (tmp_path / "shoot.yaml").read_text() == TEXT
    again = load_sequence(str(tmp_path / "out.yaml"), LIMITS, "rig")
    assert [key.position for key in again.keys[PAN]] == [-27.6543, 12.3457, 22.3457]


def test_an_axis_that_was_not_trimmed_stands_as_it_was_written_and_so_do_line_ends(tmp_path: Path):
    text = TEXT.replace("\n", "\r\n")
    file = trimmed(tmp_path, text)
    assert file.text({PAN: State(0.0), TILT: State(1e-9)}).replace("tilt: 0.25", "") != ""
    assert file.text({}) == text
    file.write({PAN: State(1.0)})
    assert (tmp_path / "out.yaml").read_bytes().decode() == text.replace("-30", "-29").replace("1e1", "11").replace(
        "pan: 20", "pan: 21"
    )


def test_rounding_leaves_no_soft_limit(tmp_path: Path):
    file = trimmed(tmp_path, TEXT)
    assert "tilt: 40," in file.text({TILT: State(0.00014)})


def test_what_is_no_plain_number_is_refused_beforehand_and_all_of_it(tmp_path: Path):
    text = "keyframes:\n  - {at: 0, pan: &start 3}\n  - {at: 4, pan: 0x10}\n  - {at: 8, pan: *start}\n"
    text += "cues: [{at: 0, recenter: 2s}]\n"
    with pytest.raises(DocumentError) as refusal:
        trimmed(tmp_path, text)
    assert [problem.partition(".yaml:")[2] for problem in refusal.value.problems] == [
        "5:26: cue 1: recenter always goes to 0: --trim-out cannot move it",
        "2:18: key 1: pan must be a plain number to be moved by --trim-out",
        "3:18: key 2: pan must be a plain number to be moved by --trim-out",
        "2:18: key 3: pan must be a plain number to be moved by --trim-out",
    ]


def test_nothing_is_written_over_and_what_cannot_be_written_is_said(tmp_path: Path):
    (tmp_path / "out.yaml").write_text("precious")
    with pytest.raises(UsageError, match="already exists"):
        trimmed(tmp_path, TEXT)
    (tmp_path / "out.yaml").unlink()
    with pytest.raises(OutputError, match=r"out\.yaml: cannot be written: No such file or directory"):
        TrimmedFile(str(tmp_path / "shoot.yaml"), tmp_path / "no" / "out.yaml", [PAN], LIMITS)  # before the run
    (tmp_path / "no").mkdir()
    file = TrimmedFile(str(tmp_path / "shoot.yaml"), tmp_path / "no" / "out.yaml", [PAN], LIMITS)
    (tmp_path / "no").rmdir()
    with pytest.raises(OutputError, match=r"out\.yaml: cannot be written: No such file or directory"):
        file.write({PAN: State(1.0)})
