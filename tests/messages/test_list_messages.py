"""messages.txt has every text that a user may read, so that a reviewer can read them all at once."""

from __future__ import annotations

from pathlib import Path

from list_messages import EXPECTED, REGENERATE, ROOT, messages, texts


def test_the_list_of_messages_is_up_to_date() -> None:
    current = EXPECTED.read_text(encoding="utf-8")
    assert messages() == current, f"the texts changed: run `{REGENERATE}`, read the difference, commit it"


def found_in(tmp_path: Path, source: str, room: str = "core") -> list[str]:
    file = tmp_path / "module.py"
    file.write_text(source, encoding="utf-8")
    return list(texts(file, room))


def test_texts_of_calls_and_errors_are_listed_with_placeholders(tmp_path: Path) -> None:
    source = (
        'notify(f"{axis} moves {speed:.1f} deg/s")\nraise DeviceError("closed")\ncompile("not a message")\nkey = "x"'
    )
    assert found_in(tmp_path, source) == ["{axis} moves {speed} deg/s", "closed"]


def test_docstrings_are_listed_where_users_read_them(tmp_path: Path) -> None:
    source = '''
class Rig:
    """For programmers."""
    name: str
    """The name of the rig."""

def copy(file: Annotated[str, Parameter(help="The new file.")]) -> None:
    """Copy a file."""

def _helper() -> None:
    """For programmers too."""
'''
    assert found_in(tmp_path, source, "cli") == ["name: The name of the rig.", "Copy a file.", "The new file."]
    assert found_in(tmp_path, source, "links") == ["The new file."]


def test_the_list_has_texts_of_every_kind() -> None:
    lines = EXPECTED.read_text(encoding="utf-8")
    for source in ("cli/take/list.py", "config/sinks_section.py", "planner/live.py"):
        assert (ROOT / "teleop" / source).exists()
    assert "teleop/cli/shipped_files.py\n" in lines
    assert "The rig: a shipped profile's name, or a file." in lines
