"""Tab completion, installed by `teleop --install-completion` into a throw-away home, as the shell itself asks."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from command import TELEOP, teleop
from waiting import DEADLINE

ASK = """
. ~/.bashrc
tab() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _teleop; echo "${COMPREPLY[*]}"; }
complete -p teleop
"""
ROWS = {
    "teleop pl": "play",
    "teleop play re": "reveal",
    "teleop play m": "montage mine.yaml moves/",
    "teleop play moves/": "moves/deep.yaml",
    "teleop check ./m": "./mine.yaml ./moves/",
    "teleop play reveal --rig rs": "rs2 rs3-pro rs4-pro rs5",
    "teleop play reveal --spe": "--speed",
    "teleop copy dual": "dualsense dualshock4",
    "teleop list ''": "moves rigs pads",
    "teleop take rep": "report",
    "teleop import sh": "shot.chan shot.txt",
    "teleop export re": "reveal",
}


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for variable in ("ZSH", "ZSH_CUSTOM"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("PATH", f"{Path(TELEOP).parent}{os.pathsep}{os.environ['PATH']}")
    return tmp_path


def test_in_bash_the_tab_key_knows_commands_moves_rigs_files_and_options(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SHELL", "/bin/bash")
    done = teleop("--install-completion", cwd=home)
    assert done.returncode == 0, done.stderr
    work = home / "work"
    (work / "moves").mkdir(parents=True)
    for name in ("mine.yaml", "moves/deep.yaml", "notes.txt", "shot.chan", "shot.txt", "shot.jpg"):
        (work / name).touch()
    script = ASK + "".join(f"tab {line}\n" for line in ROWS)
    bash = ["bash", "--norc", "-c", script]
    asked = subprocess.run(bash, capture_output=True, text=True, cwd=work, check=True, timeout=DEADLINE)
    assert asked.stdout.splitlines() == ["complete -F _teleop teleop", *ROWS.values()]
    before = (home / ".bashrc").read_text()
    assert teleop("--install-completion", cwd=home).returncode == 0
    assert (home / ".bashrc").read_text() == before, "a second time changes nothing"


@pytest.mark.parametrize(
    ("shell", "file"),
    [("zsh", ".zsh/completions/_cyclopts_teleop"), ("fish", ".config/fish/completions/teleop.fish")],
)
def test_zsh_and_fish_have_theirs_where_they_look_for_it(shell: str, file: str, home: Path) -> None:
    done = teleop("--install-completion", "--shell", shell, cwd=home)
    assert done.returncode == 0, done.stderr
    assert "play" in (home / file).read_text()
    if shutil.which(shell):  # where it is installed, it has to take it
        subprocess.run([shell, "-n", str(home / file)], check=True, timeout=DEADLINE)


def test_a_shell_that_is_none_of_these_is_named_in_one_line(home: Path) -> None:
    done = teleop("--install-completion", "--shell", "tcsh", cwd=home)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
