"""A sequence file with all that it includes: every error at once, each file parsed once (texts: `test_include`)."""

from __future__ import annotations

from pathlib import Path

from sequences import LIMITS
from teleop.core.axes import Axis
from teleop.sequence.reader import SequenceReader

PART = "keyframes:\n- {at: 0, tilt: 0}\n- {at: 2, tilt: 10}\n"


def read(folder: Path, text: str) -> tuple[SequenceReader, list[float] | None]:
    """The reader, and the times of the tilt's keys."""
    (folder / "part.yaml").write_text(PART)
    (folder / "shoot.yaml").write_text(text)
    reader = SequenceReader(LIMITS, "the rig")
    timeline = reader.read(folder / "shoot.yaml", "shoot.yaml")
    return reader, None if timeline is None else [key.at for key in timeline.keys[Axis.TILT]]


def test_a_file_may_be_included_twice_and_is_parsed_once(tmp_path: Path) -> None:
    reader, times = read(tmp_path, "include:\n- {move: part.yaml, at: 1}\n- {move: part.yaml, at: 5, speed: 200%}\n")
    assert times == [1, 3, 5, 6]
    assert len(reader._documents) == 2
    assert reader.problems == []


def test_the_errors_of_all_files_come_at_once_and_an_included_one_says_where(tmp_path: Path) -> None:
    (tmp_path / "wrong.yaml").write_text("keyframes: [{at: 0, pan: 900}]\n")
    reader, times = read(tmp_path, "include: [{move: wrong.yaml, at: 0}]\nkeyframes: [{at: 0, pna: 1, tilt: 0}]\n")
    assert times is None
    assert [problem.split(":")[0] for problem in reader.problems] == ["shoot.yaml", "wrong.yaml"]
    assert reader.problems[1].endswith("(included at shoot.yaml:1:11)")


def test_what_only_the_rig_cannot_do_is_counted_apart(tmp_path: Path) -> None:
    reader, _ = read(tmp_path, "keyframes: [{at: 0, tilt: 900}]\n")
    assert (len(reader.problems), reader.beyond_rig) == (1, 1)
