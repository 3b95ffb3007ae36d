"""Pads as files."""

from __future__ import annotations

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.pad_file import load_pad
from teleop.config.resources import described


@pytest.mark.parametrize("name", sorted(described("profiles/pads")))
def test_every_shipped_pad_is_valid_and_names_its_devices(name):
    pad = load_pad(name)
    assert pad.name
    assert pad.devices


def test_another_kind_of_file_is_named_as_such(tmp_path):
    (tmp_path / "rig.yaml").write_text("axes: {}\n")
    with pytest.raises(DocumentError, match="this is a profile"):
        load_pad(str(tmp_path / "rig.yaml"))


def test_every_mistake_in_a_pad_has_its_line(tmp_path):
    file = tmp_path / "pad.yaml"
    file.write_text("name: Own\ndevices: [{name: x}]\ncontrols:\n  Button 1: {pressed_by: stop}\n  X: 3\n")
    with pytest.raises(DocumentError) as error:
        load_pad(str(file))
    assert any(problem.startswith(f"{file}:4:") for problem in error.value.problems)
    assert any(problem.startswith(f"{file}:5:") for problem in error.value.problems)
