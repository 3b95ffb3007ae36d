"""A preview replaces a preview, and no other file."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.cli import run
from teleop.cli.own_files import check_own
from teleop.core.errors import UsageError


@pytest.mark.parametrize("name", ["move.html", "move.csv"])
def test_what_teleop_wrote_it_writes_again(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    option = "--csv" if name.endswith("csv") else "-o"
    assert [run(["preview", "nudge", option, name]) for _ in range(2)] == [0, 0]


@pytest.mark.parametrize("name", ["notes.html", "drawing.svg", "photo.png", "list.csv"])
def test_what_others_wrote_stays(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    Path(name).write_text("mine, not a preview")
    option = "--csv" if name.endswith("csv") else "-o"
    assert run(["preview", "nudge", option, name]) == 2
    wrong = f"teleop: {option and name}: exists, and teleop did not write it; choose another name, or delete it\n"
    assert capsys.readouterr().err == wrong
    assert Path(name).read_text() == "mine, not a preview"


def test_an_empty_file_a_new_one_and_a_stream_are_free(tmp_path: Path) -> None:
    (tmp_path / "empty.html").touch()
    for path in (tmp_path / "empty.html", tmp_path / "new.html", Path("/dev/null")):
        check_own(path)
    (tmp_path / "foreign.html").write_text("x")
    with pytest.raises(UsageError, match="teleop did not write it"):
        check_own(tmp_path / "foreign.html")
