"""Where shipped files and the user's own are found."""

from __future__ import annotations

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.resources import described, find, folder, is_bare


@pytest.mark.parametrize(("name", "bare"), [("reveal", True), ("reveal.yaml", False), ("./reveal", False)])
def test_only_a_name_without_folder_and_ending_is_a_shipped_files(name, bare):
    assert is_bare(name) is bare


def test_a_shipped_file_is_found_and_called_by_its_file_name():
    assert find("reveal", "sequences", "sequence") == (folder("sequences") / "reveal.yaml", "reveal.yaml")


def test_a_path_is_taken_from_the_folder_beside(tmp_path):
    (tmp_path / "own.yaml").write_text("")
    assert find("own.yaml", "sequences", "sequence", tmp_path) == (tmp_path / "own.yaml", "own.yaml")


def test_a_home_folder_is_found(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "own.yaml").write_text("")
    assert find("~/own.yaml", "profiles", "rig")[0] == tmp_path / "own.yaml"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("./none.yaml", "no such file"),
        ("./", "is no file"),
        ("reveel", "did you mean reveal"),
        ("zzzz", "a file needs its ending, zzzz.yaml"),
    ],
)
def test_what_is_not_there_is_an_error_with_its_cure(name, words):
    with pytest.raises(DocumentError, match=words):
        find(name, "sequences", "sequence")


@pytest.mark.parametrize("kind", ["sequences", "profiles", "profiles/pads"])
def test_every_shipped_file_describes_itself_in_its_first_line(kind):
    assert all(described(kind).values())
