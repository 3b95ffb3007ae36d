"""The folders of a user, as XDG's base directory specification has them."""

from __future__ import annotations

from pathlib import Path

import platformdirs
import pytest

from teleop.config.folders import config_folder, state_folder
from teleop.core.errors import UsageError

FOLDERS = [
    (state_folder, "XDG_STATE_HOME", ".local/state", "user_state_path"),
    (config_folder, "XDG_CONFIG_HOME", ".config", "user_config_path"),
]


@pytest.mark.parametrize(("folder", "variable", "default", "source"), FOLDERS)
def test_a_folder_is_where_xdg_says(folder, variable, default, source, monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv(variable, raising=False)
    assert folder("") == tmp_path / default / "teleop"
    monkeypatch.setenv(variable, "relative")  # the specification says to ignore it
    assert folder("") == tmp_path / default / "teleop"
    monkeypatch.setenv(variable, str(tmp_path / "own"))
    assert folder("") == tmp_path / "own" / "teleop"
    assert not (tmp_path / "own").exists()  # asking makes nothing


@pytest.mark.parametrize(("folder", "variable", "default", "source"), FOLDERS)
def test_a_user_without_a_home_is_told_the_cure(folder, variable, default, source, monkeypatch):
    monkeypatch.setattr(platformdirs, source, lambda *_args, **_options: Path("~") / default)
    with pytest.raises(UsageError, match=r"^there is no home directory: give FILE$"):
        folder("give FILE")
