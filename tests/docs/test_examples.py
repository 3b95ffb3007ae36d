"""Every example of README.md and docs/ does what its page says: Python blocks and `teleop` commands, page by page.

A fenced block with `file=NAME` is a file that the commands of its page use. What needs hardware, a hand or an
installation has `<!-- no-run: reason -->` above it.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from teleop.config.inputs_section import PadSection

ROOT = Path(__file__).parents[2]
PAGES = {str(page.relative_to(ROOT)): page for page in [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))]}
NOT_RUN = re.compile(r"<!-- no-run: \S.*?-->\n\n(?: {4}.*\n)+")
FENCE = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
DOCS = [page for page in PAGES if page != "README.md"]  # .ci/run types the README's commands, in real time


def blocks(page: str) -> list[tuple[str, str, str]]:
    """Each fenced block: its language, what follows on that line, and its text."""
    return FENCE.findall(PAGES[page].read_text(encoding="utf-8"))


def commands(page: str) -> list[str]:
    """The `teleop` lines of a page's indented and shell blocks that are to be run, in order."""
    text = NOT_RUN.sub("", PAGES[page].read_text(encoding="utf-8"))
    shell = "".join(body for language, _, body in FENCE.findall(text) if language == "shell")
    return re.findall(r"^(?: {4,8})?(teleop \S.*)$", FENCE.sub("", text) + shell, re.MULTILINE)


def python(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "XDG_STATE_HOME": str(cwd / "state"), "COLUMNS": "100"}
    return subprocess.run(
        [sys.executable, *arguments], cwd=cwd, env=environment, capture_output=True, text=True, timeout=100
    )


def teleop(line: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    words = line.partition("#")[0].split()[1:]
    return python("-c", "import sys; from teleop.cli import main; main(sys.argv[1:])", *words, cwd=cwd)


@pytest.mark.parametrize("page", [page for page in PAGES if any(each[0] == "python" for each in blocks(page))])
def test_python(page: str, tmp_path: Path) -> None:
    for language, _, text in blocks(page):
        if language == "python":
            ran = python("-c", text, cwd=tmp_path)
            assert ran.returncode == 0, ran.stderr


@pytest.mark.parametrize("page", [page for page in DOCS if commands(page)])
def test_commands(page: str, tmp_path: Path) -> None:
    for _, marks, text in blocks(page):
        if name := re.search(r"file=(\S+)", marks):
            (tmp_path / name[1]).write_text(text, encoding="utf-8")
    for line in commands(page):
        ran = teleop(line, tmp_path)
        assert ran.returncode == 0, f"{line}\n{ran.stderr}"


@pytest.mark.parametrize("page", [page for page in PAGES if any("sequence" in each[1] for each in blocks(page))])
def test_sequences(page: str, tmp_path: Path) -> None:
    for _, marks, text in blocks(page):
        if "sequence" in marks:
            (tmp_path / "example.yaml").write_text(text, encoding="utf-8")
            ran = teleop("teleop check example.yaml", tmp_path)
            assert ran.returncode == 0, ran.stderr


def test_pads() -> None:
    pads = [text for page in PAGES for language, marks, text in blocks(page) if (language, marks) == ("yaml", " pad")]
    for text in pads:
        PadSection.model_validate(yaml.safe_load(text))
    assert pads


def test_there_are_commands_to_run() -> None:
    assert sum(len(commands(page)) for page in DOCS) > 12
