"""A file of another kind is refused in one line that says where it belongs."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.file_kinds import kind_of
from teleop.config.pad_file import load_pad
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.sequence.compile import load_sequence


def refusal(load, *arguments) -> list[str]:
    with pytest.raises(DocumentError) as caught:
        load(*arguments)
    return caught.value.problems


def test_a_profile_given_as_a_sequence_is_one_error() -> None:
    file = str(folder("profiles") / "sim.yaml")
    [problem] = refusal(load_sequence, file, load_profile("sim").limits, "sim")
    assert problem.endswith(": this is a profile: give it with --rig")
    assert problem.startswith(f"{file}:3:1: ")


def test_a_sequence_given_as_a_rig_or_a_pad_is_one_error() -> None:
    file = str(folder("sequences") / "reveal.yaml")
    for load in (load_profile, load_pad):
        [problem] = refusal(load, file)
        assert problem.endswith(": this is a sequence: give it to `teleop play`")


def test_a_pad_given_as_a_rig_is_one_error() -> None:
    [problem] = refusal(load_profile, str(folder("profiles/pads") / "xbox.yaml").replace("xbox", "xbox-bluetooth"))
    assert "this is a pad: name it in a profile" in problem


def test_a_file_with_keys_of_two_kinds_is_of_neither_and_its_keys_are_named(tmp_path: Path) -> None:
    assert kind_of({"keyframes": [], "links": {}}) == kind_of({"title": ""}) == kind_of([1]) == ""
    (tmp_path / "both.yaml").write_text("keyframes: [{at: 0, pan: 1}]\nlinks: {}\n")
    problems = refusal(load_sequence, str(tmp_path / "both.yaml"), load_profile("sim").limits, "sim")
    assert problems == [f"{tmp_path}/both.yaml:2:1: unknown key `links`"]
