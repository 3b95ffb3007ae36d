"""Marked targets go into a sequence file and leave the rest of it as it is; a disk that fails is a line."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from teleop.app import target_file
from teleop.app.target_file import TargetFile
from teleop.config.documents.document import DocumentError
from teleop.config.files import OutputError
from teleop.core.events import Tick
from teleop.planner.aim import Point

TICK = Tick(0.0, {}, {}, (), {})


def test_a_new_file_gets_the_targets(tmp_path: Path) -> None:
    file = TargetFile(tmp_path / "new.yaml")
    file.add("door", Point(4, 1.2, 1.6))
    file.add("vase", Point(0, 3, 1))
    file.close()
    assert yaml.safe_load((tmp_path / "new.yaml").read_text()) == {
        "targets": {"door": [4, 1.2, 1.6], "vase": [0, 3, 1]}
    }


def test_the_rest_of_a_sequence_stays_as_it_is(tmp_path: Path) -> None:
    text = "# mine\nmount: 1.5  # measured\ntargets:\n  door: [1, 2, 3]  # old\nkeyframes:\n- {at: 0, aim: door}\n"
    (tmp_path / "a.yaml").write_text(text)
    file = TargetFile(tmp_path / "a.yaml")
    assert file.height == 1.5
    file.add("door", Point(4, 1.2, 1.6))
    file.close()
    assert (tmp_path / "a.yaml").read_text() == text.replace("[1, 2, 3]", "[4, 1.2, 1.6]")


def test_without_a_mark_nothing_is_written(tmp_path: Path) -> None:
    TargetFile(tmp_path / "new.yaml").close()
    assert not (tmp_path / "new.yaml").exists()


def test_a_file_that_is_no_sequence_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "rig.yaml").write_text("name: rig\nlinks: {}\n")
    with pytest.raises(DocumentError, match=r"rig\.yaml:1:1"):
        TargetFile(tmp_path / "rig.yaml")
    with pytest.raises(OutputError):
        TargetFile(tmp_path / "none" / "new.yaml")


def test_a_disk_that_fails_is_told_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, _text: str) -> None:
        raise OutputError(path, "No space left on device")

    monkeypatch.setattr(target_file, "write_text", full)
    told: list[str] = []
    file = TargetFile(tmp_path / "new.yaml")
    file.notify = told.append
    file.add("door", Point(1, 2, 3))
    file.close()
    file.observe(TICK)
    file.close()
    assert len(told) == 1
    assert "targets are not saved" in told[0]
    assert "No space left on device" in told[0]
