"""`teleop list`, `teleop copy`, a bare `teleop play`: what comes with the program is found, and can be made yours."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sequences import RIGS
from teleop.cli import run
from teleop.cli.shipped_files import FOLDERS
from teleop.config.documents.document import DocumentError
from teleop.config.documents.yaml_loader import read_document
from teleop.config.pad_file import load_pad
from teleop.config.profile import load_profile
from teleop.config.resources import described, folder
from teleop.sequence.compile import load_sequence

EVERYTHING = [(kind, name) for kind, place in FOLDERS.items() for name in described(place)]
GIMBALS = ["rs2", "rs3-pro", "rs4-pro", "rs5"]
NEEDS_MORE = {"whip-pan", "montage", "panorama", "product-orbit", "fly-by"}
"""What the slow profiles cannot play, as sequences/README.md says."""


def test_a_list_has_a_line_of_80_columns_for_each_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) < 80
    for kind, name in EVERYTHING:
        [line] = [line for line in lines if line.split()[:1] == [name]]
        assert len(line.split(maxsplit=1)[1]) > 10, f"what {kind} {name} is"
    assert [line.split()[0] for line in lines if line.endswith(":")] == ["Moves", "Rigs", "Pads"]
    assert "teleop play NAME" in lines[0]


def test_a_list_of_one_kind_and_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["list", "rigs"]) == 0
    printed = capsys.readouterr().out
    assert "sim-drone" in printed
    assert "reveal" not in printed
    assert run(["list", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [(kind, each["name"]) for kind, entries in found.items() for each in entries] == EVERYTHING
    assert all(Path(each["path"]).is_file() and each["description"] for of in found.values() for each in of)
    assert run(["list", "mvoes"]) == 2


@pytest.mark.parametrize(("kind", "name"), EVERYTHING)
def test_a_copy_is_the_same_to_the_byte_and_of_use_in_any_folder(
    kind: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["copy", name, "mine.yaml"]) == 0
    assert capsys.readouterr().out.startswith(f"mine.yaml: a copy of {name}. Use it: ")
    original = folder(FOLDERS[kind]) / f"{name}.yaml"  # type: ignore[index]  # a kind, by its name
    assert Path("mine.yaml").read_bytes() == original.read_bytes()
    if kind == "rigs":
        assert load_profile("mine.yaml") == load_profile(name)
    elif kind == "pads":
        assert load_pad("mine.yaml") == load_pad(name)
    else:
        assert run(["check", "mine.yaml", "--rig", RIGS.get(name, "sim"), "--json"]) == 0


def test_a_shipped_move_names_others_by_their_bare_names_so_that_copies_find_them() -> None:
    for name in described("sequences"):
        for entry in read_document(folder("sequences") / f"{name}.yaml", name).data.get("include", []):
            assert entry["move"] in described("sequences")


def test_a_copy_is_refused_in_one_line_and_nothing_is_written_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("there.yaml").write_text("mine")
    Path("dangling.yaml").symlink_to("nowhere.yaml")
    Path("folder").mkdir()
    rows = {
        ("reveal", "there.yaml"): "teleop: there.yaml: already exists; choose another name",
        ("reveal", "dangling.yaml"): "teleop: dangling.yaml: already exists; choose another name",
        ("revael", "new.yaml"): "revael: no move, rig or pad of that name is shipped; did you mean reveal?",
        ("./reveal.yaml", "new.yaml"): "./reveal.yaml: only shipped files are copied, by their bare names; teleop list"
        " names them",
        ("reveal", "folder"): "teleop: folder: is a folder; name the file too, as in folder/mine.yaml",
        ("reveal", "new"): "teleop: new: a file needs its ending, new.yaml",
        ("reveal", "none/new.yaml"): "teleop: none/new.yaml: there is no folder none",
    }
    for arguments, said in rows.items():
        assert run(["copy", *arguments]) == 2
        assert capsys.readouterr() == ("", f"{said}\n")
    assert Path("there.yaml").read_text() == "mine"
    assert sorted(path.name for path in Path().iterdir()) == ["dangling.yaml", "folder", "there.yaml"]


@pytest.mark.parametrize("verb", ["play", "check", "preview"])
def test_without_a_name_the_moves_are_listed_and_nothing_was_done(
    verb: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run([verb]) == 2
    printed = capsys.readouterr()
    assert all(f"  {name} " in printed.out for name in described("sequences"))
    assert printed.err == f"teleop: name a move to {verb}, as in: teleop {verb} reveal\n"
    assert run([verb, "--json"]) == 2
    assert [each["name"] for each in json.loads(capsys.readouterr().out)["moves"]] == list(described("sequences"))


@pytest.mark.parametrize("rig", GIMBALS)
def test_a_real_gimbal_is_shipped_slow_with_the_full_values_beside(rig: str) -> None:
    profile = load_profile(rig)
    for axis in ("pan", "tilt", "roll"):
        limits = next(of for name, of in profile.axes.items() if name == axis)
        assert limits.min is not None
        assert limits.max is not None
        assert limits.min >= -60
        assert limits.max <= 60
        assert limits.velocity <= 30
    assert [sink.mode for sink in profile.sinks if sink.type == "gimbal"] == ["position"]
    text = (folder("profiles") / f"{rig}.yaml").read_text()
    for full in ("-180..180, 120, 240, 1200", "90, 180, 900", "-30..30, 60, 120, 600"):
        assert full in text
    assert "Never tried on hardware" in text
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("rig", GIMBALS)
def test_what_the_slow_profiles_cannot_play_is_in_the_readme(rig: str) -> None:
    refused = set()
    for name in described("sequences"):
        if name == "day-to-night":
            continue  # a timelapse: its path is slow
        try:
            load_sequence(name, load_profile(rig).limits, rig)
        except DocumentError:
            refused.add(name)
    assert refused == NEEDS_MORE
    readme = (folder("sequences") / "README.md").read_text()
    [paragraph] = [part for part in readme.split("\n\n") if "full limits" in part]
    assert all(f"`{name}`" in paragraph for name in NEEDS_MORE)
