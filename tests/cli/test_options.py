"""The options that commands share."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from teleop.cli.options import Options, announce, announce_json
from teleop.config.documents.document import DocumentError


def test_a_link_replaces_the_profiles_own():
    assert Options(link=("gimbal=socketcan:can0",)).profile().links == {"gimbal": "socketcan:can0"}


@pytest.mark.parametrize("text", ["gimbal", "=sim:", "gimbal:sim"])
def test_a_link_without_name_and_url_is_refused_with_an_example(text):
    with pytest.raises(DocumentError, match=f"--link {text}: write it as NAME=URL"):
        Options(link=(text,)).profile()


def test_an_error_about_a_link_names_the_option():
    with pytest.raises(DocumentError, match=r"^--link camera: "):
        Options(link=("camera=sim:",)).profile()


@pytest.mark.parametrize("as_json", [True, False])
def test_a_plan_that_fails_is_json_for_programs(tmp_path, capsys, as_json):
    (tmp_path / "a.yaml").write_text("keyframes: 3\n")
    with pytest.raises(DocumentError):
        Options(json=as_json).plan(str(tmp_path / "a.yaml"))
    printed = capsys.readouterr().out
    assert bool(printed) is as_json
    if as_json:
        assert json.loads(printed)["ok"] is False


def test_lines_about_a_file_on_stdout_go_to_stderr(capsys):
    announce("written", Path("a.csv"))
    announce_json({"ok": True}, Path("/dev/stdout"))
    printed = capsys.readouterr()
    assert printed.out == "written\n"
    assert json.loads(printed.err) == {"ok": True}
