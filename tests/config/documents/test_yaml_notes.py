"""Comments of our own above a place: new ones, those of an earlier run, and what else is there."""

from __future__ import annotations

import pytest

from teleop.config.documents.yaml_notes import with_notes

TEXT = """# mine
sinks:  # three
  # about the first
  - {type: gimbal}   # the first
  - {type: focus}
axes:
  pan: {min: 1}
"""


def noted(text: str, *lines: str) -> str:
    return with_notes(text, {("sinks", 0): lines}, "ours")


def test_notes_go_above_their_place_and_the_rest_keeps_its_bytes() -> None:
    done = with_notes(TEXT, {("sinks", 0): ["found today", "a 1: seen"], ("axes", "pan"): ["min 1: seen"]}, "ours")
    added = ["  # ours: found today\n", "  # ours: a 1: seen\n", "  # ours: min 1: seen\n"]
    lines = done.splitlines(keepends=True)
    assert [line for line in lines if line in added] == added
    assert "".join(line for line in lines if line not in added) == TEXT
    assert lines.index("  # ours: a 1: seen\n") + 1 == lines.index("  - {type: gimbal}   # the first\n")


def test_the_next_run_replaces_what_it_found_again_and_keeps_the_rest_with_its_heading() -> None:
    first = noted(TEXT, "found in May", "a 1: seen", "b 2: seen")
    second = noted(first, "found in June", "b 3: asked")
    both = "  # ours: found in June\n  # ours: b 3: asked\n  # ours: found in May\n  # ours: a 1: seen\n"
    assert second == TEXT.replace("  - {type: gimbal}", both + "  - {type: gimbal}")
    third = noted(second, "found in July", "a 4: seen", "b 5: seen")
    assert third == noted(TEXT, "found in July", "a 4: seen", "b 5: seen")
    assert noted(third, "found in July", "a 4: seen", "b 5: seen") == third


@pytest.mark.parametrize("text", [TEXT.replace("\n", "\r\n"), "\ufeff" + TEXT], ids=["Windows", "a mark at its begin"])
def test_line_ends_and_the_mark_of_an_editor_stay(text: str) -> None:
    done = noted(text, "a 1: seen")
    assert ("\r\n" in text) == ("# ours: a 1: seen\r\n" in done)
    assert "".join(line for line in done.splitlines(keepends=True) if "ours" not in line) == text


def test_a_place_that_there_is_not_and_no_notes_change_nothing() -> None:
    assert with_notes(TEXT, {("sinks", 7): ["a 1: seen"], ("axes",): []}, "ours") == TEXT
