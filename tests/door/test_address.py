"""Where the door of a run is."""

import stat
from pathlib import Path

import pytest

from teleop.door import address
from teleop.door.address import new_door


def test_it_is_in_the_runtime_folder_of_this_user_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tmp_path.chmod(0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    with new_door() as door:
        assert door.folder.parent == tmp_path
        assert stat.S_IMODE(door.folder.stat().st_mode) == 0o700
        (door.folder / "ring").touch()
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize("named", ["open to all", "relative", "missing"])
def test_else_it_is_in_memory_where_a_write_waits_for_no_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, named: str
) -> None:
    memory, shared = tmp_path / "memory", tmp_path / "shared"
    memory.mkdir()
    shared.mkdir(mode=0o755)
    monkeypatch.setattr(address, "MEMORY", str(memory))
    runtime = {"open to all": str(shared), "relative": "shared", "missing": str(tmp_path / "no")}[named]
    monkeypatch.setenv("XDG_RUNTIME_DIR", runtime)
    with new_door() as door:
        assert door.folder.parent == memory
