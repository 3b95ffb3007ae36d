"""Presets: what is kept between runs, what is refused with its line, and a disk that is full."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs
import pytest
from hands import LIMITS
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.documents.document import DocumentError
from teleop.config.presets import Preset, Presets, default_file, read_presets, write_presets
from teleop.core.axes import Axis
from teleop.core.errors import UsageError

RIG = "Test rig"


def problems(tmp_path: Path, text: str) -> list[str]:
    (tmp_path / "presets.yaml").write_text(text)
    with pytest.raises(DocumentError) as caught:
        read_presets(tmp_path / "presets.yaml", LIMITS, RIG)
    return [problem.removeprefix(f"{tmp_path}/") for problem in caught.value.problems]


def test_what_is_stored_is_there_in_the_next_run(tmp_path: Path) -> None:
    file = tmp_path / "deep" / "presets.yaml"
    shelf = read_presets(file, LIMITS, RIG)
    assert dict(shelf.names) == {}
    shelf.store(2, {Axis.PAN: 10.00001, Axis.TILT: -3.2})
    shelf.store(0, {Axis.FOCUS: 0.25})
    shelf.store(1, {Axis.PAN: 1.0})
    assert shelf.delete(1)
    assert not shelf.delete(1)
    shelf.close()
    assert "  2: {pan: 10.0, tilt: -3.2}\n" in file.read_text()
    again = read_presets(file, LIMITS, RIG)
    assert dict(again.names) == {0: "", 2: ""}
    assert again.get(2) == Preset({Axis.PAN: 10.0, Axis.TILT: -3.2})
    assert list(tmp_path.glob("deep/.*")) == []


def test_marks_of_the_focus_are_kept_beside_the_presets(tmp_path: Path) -> None:
    file = tmp_path / "presets.yaml"
    shelf = read_presets(file, LIMITS, RIG)
    shelf.mark("B", 0.80001)
    shelf.mark("A", 0.25)
    shelf.mark("C", 1)
    shelf.mark("C", None)
    shelf.store(1, {Axis.PAN: 1.0})
    assert shelf.changes == 5
    shelf.close()
    assert file.read_text().endswith("  1: {pan: 1.0}\nfocus_marks: {A: 0.25, B: 0.8}\n")
    assert read_presets(file, LIMITS, RIG).marks == {"A": 0.25, "B": 0.8}


def test_a_name_and_an_axis_of_another_rig_survive_a_store(tmp_path: Path) -> None:
    file = tmp_path / "presets.yaml"
    file.write_text('presets:\n  1: {pan: 1, roll: 5, name: "wide \\u00e9"}\n')
    shelf = read_presets(file, LIMITS, RIG)
    assert [said.removeprefix(f"{tmp_path}/") for said in shelf.new_messages()] == [
        "presets.yaml:2:21: presets.1.roll is not used: Test rig has no roll"
    ]
    assert list(shelf.new_messages()) == []
    shelf.store(1, {Axis.PAN: 2.0})
    shelf.close()
    assert read_presets(file, LIMITS, RIG).get(1) == Preset({Axis.PAN: 2.0, Axis.ROLL: 5.0}, "wide \xe9")


def test_a_preset_beyond_the_soft_limits_is_said(tmp_path: Path) -> None:
    file = tmp_path / "presets.yaml"
    file.write_text("presets:\n  7: {pan: 200}\n")
    [said] = read_presets(file, LIMITS, RIG).new_messages()
    assert said.endswith("2:12: presets.7.pan is outside the soft limits (-180..180): a recall stops at the limit")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "presets.yaml:1:1: the file is empty"),
        ("presets: {\n", "presets.yaml:2:1: not YAML"),
        ("preset: {}\n", "presets.yaml:1:1: unknown key `preset`; did you mean `presets`?"),
        ("presets:\n  wide: {pan: 1}\n", "presets.yaml:2:9: presets.wide must be a number from 0 to 999"),
        ("presets:\n  01: {pan: 1}\n", "presets.yaml:2:7: presets.01 must be a number from 0 to 999"),
        ("presets:\n  1: {pna: 1}\n", "presets.yaml:2:7: presets.1: unknown key `pna`; did you mean `pan`?"),
        ("presets:\n  1: {pan: far}\n", "presets.yaml:2:12: presets.1.pan must be a number, not 'far'"),
        ("presets:\n  1: {pan: .nan}\n", "presets.yaml:2:12: presets.1.pan must be a finite number, not nan"),
        ("presets:\n  1: {name: x}\n", "presets.yaml:2:6: presets.1 has no axis (pan, tilt, roll, focus)"),
        ("focus_marks: {D: 0.5}\n", "presets.yaml:1:15: focus_marks.D must be one of A, B, C"),
        ("focus_marks: {A: 1.5}\n", "presets.yaml:1:18: focus_marks.A must be"),
        ("presets: 3\n", "presets.yaml:1:10: presets must be a mapping, not 3"),
    ],
)
def test_a_file_that_cannot_be_used_says_where(tmp_path: Path, text: str, problem: str) -> None:
    assert any(line.startswith(problem) for line in problems(tmp_path, text)), problems(tmp_path, text)


def test_a_folder_in_place_of_the_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="cannot be read"):
        read_presets(tmp_path, LIMITS, RIG)


def test_a_disk_that_fails_is_said_and_costs_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "presets.yaml"
    shelf = Presets(file)
    shelf.store(1, {Axis.PAN: 1.0})
    shelf.close()
    before = file.read_bytes()

    def full(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    shelf = read_presets(file, LIMITS, RIG)
    shelf.store(2, {Axis.PAN: 2.0})
    shelf.close()
    assert list(shelf.new_messages()) == [f"presets are not saved: {file}: No space left on device"]
    assert dict(shelf.names) == {1: "", 2: ""}
    assert file.read_bytes() == before
    assert os.listdir(tmp_path) == ["presets.yaml"]


def test_a_place_that_cannot_be_made_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    shelf = Presets(tmp_path / "file" / "presets.yaml")
    shelf.store(1, {Axis.PAN: 1.0})
    shelf.close()
    assert "presets are not saved" in next(shelf.new_messages())


def test_each_rig_has_a_file_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert default_file("Simulated rig") == tmp_path / "teleop" / "presets-simulated-rig.yaml"
    assert default_file("../..") == tmp_path / "teleop" / "presets-rig.yaml"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    assert default_file("x") == Path.home() / ".local/state/teleop/presets-x.yaml"


def test_no_home_is_reported_with_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platformdirs, "user_state_path", lambda *_args, **_options: Path("~/.local/state/teleop"))
    with pytest.raises(UsageError, match="--presets FILE"):
        default_file("x")


@given(
    st.dictionaries(
        st.integers(0, 999),
        st.builds(
            Preset,
            st.dictionaries(st.sampled_from(list(Axis)), st.floats(-1e6, 1e6).map(lambda x: round(x, 4)), min_size=1),
            st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"]), max_size=20),
        ),
        max_size=5,
    )
)
def test_whatever_is_written_is_read_back(tmp_path_factory: pytest.TempPathFactory, kept: dict[int, Preset]) -> None:
    file = tmp_path_factory.mktemp("presets") / "presets.yaml"
    write_presets(file, kept)
    shelf = read_presets(file, {}, RIG)
    assert {number: shelf.get(number) for number in shelf.names} == kept
