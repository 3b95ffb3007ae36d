"""Every program of examples/ runs as its docstring says, from any folder, and prints what it shows."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples"
PROGRAMS = sorted(FOLDER.glob("*.py"))
PRINTS = {
    "check_many": r"yes  nudge: Nudge, 18\.0 s\n.*no   whip-pan: .*fit: stretch`\nrs2 can play 2 of 3\n",
    "compare_takes": r"the passes differ by 0\.0\d+ deg rms, 0\.\d+ deg at most\n",
    "first_move": r"has the axes pan, tilt, roll, focus\n.*after:  \{'pan': 30\.0, 'tilt': 5\.0,",
    "jog": r"pan 20\.0, tilt -4\.0\nat the soft limit: tilt -56\.0\nrefused: jog: pan=500 .*120\n",
    "panorama": r"Panorama at 35 mm: \d+ s, a picture covers 54 x 38 deg\ndone\n",
    "plan_and_plot": r"Slow reveal: 15\.0 s\n.*tilt goes from -12\.0 to 6\.0 deg.*drawn: move\.svg\n",
    "play_and_record": r"the move took 15\.0 s; done\npan    rms 0\.\d+.*reveal\.mcap has \d+ ticks",
    "shutter_loop": r"picture 1 at pan -30\.0, tilt 0\.0\n.*picture 4 at pan 30\.0, tilt 0\.0\n",
    "stop_on_a_condition": r"the jog ended: STOPPED\nthe STOP is cleared.*\npan 10\.0\n",
    "two_rigs": r"left: done, now at pan 15\.0\nright: done, now at pan -15\.0\n",
}
"""By program: what its output has, as a regular expression in which a dot also matches a line's end."""
ALLOWED = {"teleop", "numpy"} | sys.stdlib_module_names


STALLED = "the computer stalled for"  # how a run ends when the machine gave it no time for 0.25 s


def of(path: Path) -> str:
    return path.stem


def run(program: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """As a user runs it, who has installed `teleop`: the tree is not on the path."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    environment["TMPDIR"] = str(folder)
    return subprocess.run(
        [sys.executable, program], cwd=folder, env=environment, capture_output=True, text=True, timeout=100
    )


@pytest.mark.parametrize("program", PROGRAMS, ids=of)
def test_it_runs_and_prints_what_it_shows(program: Path, tmp_path: Path) -> None:
    ran = run(program, tmp_path)
    while STALLED in ran.stderr:  # by a busy machine, in the one program that runs in real time
        ran = run(program, tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert ran.stderr == ""
    assert re.search(PRINTS[program.stem], ran.stdout, re.DOTALL), ran.stdout


@pytest.mark.parametrize("program", PROGRAMS, ids=of)
def test_it_is_short_says_how_to_run_it_and_uses_only_the_public_names(program: Path) -> None:
    text = program.read_text(encoding="utf-8")
    tree = ast.parse(text)
    assert len(text.splitlines()) <= 40
    assert f"    python {program.name}" in (ast.get_docstring(tree) or "")
    for node in ast.walk(tree):
        modules = [each.name for each in node.names] if isinstance(node, ast.Import) else []
        modules += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        for module in modules:
            assert module.partition(".")[0] in ALLOWED
            assert not module.startswith("teleop.")


def test_each_is_in_the_list_of_the_folder() -> None:
    listed = re.findall(r"\]\(([\w.]+\.(?:py|ipynb))\)", (FOLDER / "README.md").read_text(encoding="utf-8"))
    assert sorted(listed) == sorted(each.name for each in FOLDER.iterdir() if each.suffix in (".py", ".ipynb"))
    assert len(PROGRAMS) == len(PRINTS) == 10
