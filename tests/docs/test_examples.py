"""Every example of every page does what its page says: Python, YAML and shell blocks, page by page.

Behind the language of a fenced block, for these tests only (the site does not show it):

- `file=NAME`: the commands of the page find the block in this file.
- `sequence`, `pad`, `rig`: YAML of that kind, checked as one.
- `rig=NAME`: keys that replace those of a shipped profile.

What needs hardware, an operator or an installation has `<!-- no-run: reason -->` above it.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from teleop.config.documents.base_model import Section
from teleop.config.inputs_section import ControlSection, DeviceSection, InputSection, PadSection
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.core.operator_input import Command

ROOT = Path(__file__).parents[2]
FILES = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("[!.]*/README.md")]
PAGES = {str(page.relative_to(ROOT)): page.read_text(encoding="utf-8") for page in sorted(FILES)}
NOT_RUN = re.compile(r"<!-- no-run: \S.*?-->\n\n(?: {4}.*\n)+")
FENCE = re.compile(r"^```(\w*)([^\n]*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(page: str) -> list[tuple[str, str, str]]:
    """Each fenced block: its language, the mark behind it, and its text."""
    return [(language, mark.strip(), text) for language, mark, text in FENCE.findall(PAGES[page])]


def shell_lines(page: str) -> list[str]:
    """The lines that a reader types, in order: those of indented and shell blocks that are to be run."""
    text = NOT_RUN.sub("", PAGES[page])
    fenced = "".join(body for language, _, body in FENCE.findall(text) if language == "shell")
    indented = re.findall(r"^ {4,8}(\S.*)$", _without_lists(FENCE.sub("", text)), re.MULTILINE)
    return [*indented, *fenced.splitlines()]


def _without_lists(text: str) -> str:
    """Text without the continuation lines of list entries: a block of commands follows an empty line or a heading."""
    kept: list[str] = []
    inside = False
    for line in text.splitlines():
        indented = line.startswith("    ")
        inside = indented and (inside or not kept or not kept[-1].strip() or kept[-1].startswith("#"))
        kept.append(line if inside or not indented else line.lstrip())
    return "\n".join(kept)


def having(language: str, mark: str = "") -> list[str]:
    return [page for page in PAGES if any(each[0] == language and mark in each[1] for each in blocks(page))]


def python(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "XDG_STATE_HOME": str(cwd / "state"), "COLUMNS": "100"}
    return subprocess.run(
        [sys.executable, *arguments], cwd=cwd, env=environment, capture_output=True, text=True, timeout=100
    )


def teleop(line: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a command; what it plays on a simulated rig takes simulated time."""
    words = line.partition(" #")[0].split()[1:]
    fast = ["--fast"] if words[0] == "play" and "--fast" not in words else []
    return python("-c", "import sys; from teleop.cli import main; main(sys.argv[1:])", *words, *fast, cwd=cwd)


@pytest.mark.parametrize("page", having("python"))
def test_python(page: str, tmp_path: Path) -> None:
    for language, _, text in blocks(page):
        if language == "python":
            ran = python("-c", text, cwd=tmp_path)
            assert ran.returncode == 0, ran.stderr


@pytest.mark.parametrize("page", [page for page in PAGES if shell_lines(page)])
def test_commands(page: str, tmp_path: Path) -> None:
    for _, mark, text in blocks(page):
        if name := re.search(r"file=(\S+)", mark):
            (tmp_path / name[1]).write_text(text, encoding="utf-8")
    for line in shell_lines(page):
        assert line.startswith("teleop "), f"{line}: what is not a teleop command needs a no-run mark"
        ran = teleop(line, tmp_path)
        assert ran.returncode == 0, f"{line}\n{ran.stderr}"


@pytest.mark.parametrize("page", having("yaml", "sequence"))
def test_sequences(page: str, tmp_path: Path) -> None:
    for _, mark, text in blocks(page):
        if name := re.search(r"file=(\S+)", mark):
            (tmp_path / name[1]).write_text(text, encoding="utf-8")
    for _, mark, text in blocks(page):
        if "sequence" in mark:
            (tmp_path / "example.yaml").write_text(text, encoding="utf-8")
            ran = teleop("teleop check example.yaml", tmp_path)
            assert ran.returncode == 0, ran.stderr


@pytest.mark.parametrize("page", having("yaml", "rig"))
def test_profiles(page: str, tmp_path: Path) -> None:
    for _, mark, text in blocks(page):
        if found := re.fullmatch(r"rig(?:=(\S+))?", mark):
            rig = yaml.safe_load((folder("profiles") / f"{found[1]}.yaml").read_text()) if found[1] else {}
            file = tmp_path / "rig.yaml"
            file.write_text(yaml.safe_dump({**rig, **yaml.safe_load(text)}), encoding="utf-8")
            assert load_profile(str(file)).limits


@pytest.mark.parametrize("page", having("yaml", "pad"))
def test_pads(page: str) -> None:
    for _, mark, text in blocks(page):
        if mark == "pad":
            PadSection.model_validate(yaml.safe_load(text))


def test_every_action_and_key_of_the_inputs_has_a_line_and_an_example() -> None:
    page = "docs/how-to/inputs.md"
    examples = "".join(text for _, mark, text in blocks(page) if mark == "rig=sim")
    for command in set(Command) - {Command.ENABLE}:  # a key alone: of a device a button is held
        assert f"`{command}`" in PAGES[page]
        assert re.search(rf"(press|hold): {command}\b", examples), command
    for section in (InputSection, DeviceSection, ControlSection):
        for key in section.model_fields:
            assert re.search(rf"^\|[^|]*`{key}`", PAGES[page], re.MULTILINE), key
            assert f"{key}: " in examples or f"{key}:\n" in examples, key


@pytest.mark.parametrize(
    ("key", "section"), [("by", ControlSection), ("value_type", ControlSection), ("reports", InputSection)]
)
def test_every_value_of_a_key_of_the_inputs_is_named(key: str, section: type[Section]) -> None:
    for value in re.findall(r"'([\w-]+)'", str(section.model_fields[key].annotation)):
        assert f"`{value}`" in PAGES["docs/how-to/inputs.md"], value


def test_the_tables_of_the_pads_are_those_of_their_mappings() -> None:
    made = subprocess.run([sys.executable, str(ROOT / "docs" / "make_pad_tables.py"), "--check"], timeout=100)
    assert made.returncode == 0, "python docs/make_pad_tables.py"


@pytest.mark.parametrize("page", PAGES)
def test_each_block_is_one_that_is_tried(page: str) -> None:
    for language, mark, text in blocks(page):
        assert language in ("python", "yaml", "shell", "csv", "text", ""), text
        assert language != "yaml" or re.match(r"sequence|pad$|rig", mark), text
        assert language != "csv" or "file=" in mark, text


def test_there_are_examples_of_each_kind() -> None:
    assert sum(len(shell_lines(page)) for page in PAGES) > 25
    assert len(having("yaml", "sequence")) > 3
    assert len(having("yaml", "rig")) > 3
    assert having("yaml", "pad")
    assert len(having("python")) > 1
