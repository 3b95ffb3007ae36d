"""What the take commands share: where a file may be written, how a take's length and end are told."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from teleop.cli.take.options import ending_facts, length, place, problems_as_json
from teleop.config.documents.document import DocumentError
from teleop.core.errors import UsageError


@pytest.mark.parametrize(
    ("seconds", "shown"),
    [(0.5, "0.50 s"), (119.99, "119.99 s"), (120, "0:02:00"), (3599.6, "1:00:00"), (7325, "2:02:05")],
)
def test_a_length_is_in_seconds_and_from_two_minutes_on_in_hours(seconds: float, shown: str):
    assert length(seconds) == shown


def test_nothing_is_written_over_the_take_nor_over_a_file_without_being_asked(tmp_path: Path):
    take, other = tmp_path / "a.mcap", tmp_path / "b.mcap"
    take.write_bytes(b"")
    place("-o", other, False, take)
    with pytest.raises(UsageError, match="is the take itself"):
        place("-o", tmp_path / "x" / ".." / "a.mcap", True, take)
    other.write_bytes(b"")
    with pytest.raises(UsageError, match="already exists; give --overwrite"):
        place("-o", other, False, take)
    place("-o", other, True, take)


@pytest.mark.parametrize("as_json", [True, False])
def test_a_problem_is_raised_and_for_programs_an_object_too(as_json: bool, capsys: pytest.CaptureFixture[str]):
    with pytest.raises(DocumentError), problems_as_json(as_json):
        raise DocumentError(["a.mcap: is no take"])
    printed = capsys.readouterr().out
    assert (json.loads(printed) if as_json else printed) == (
        {"ok": False, "problems": ["a.mcap: is no take"]} if as_json else ""
    )


def test_an_end_that_the_file_does_not_say_is_null():
    assert ending_facts(None) == {"result": None, "reasons": [], "dropped": None}
