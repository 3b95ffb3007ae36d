"""Each command and option that a page names in passing is one of the program."""

import re
from functools import cache
from pathlib import Path

import pytest
from rich.console import Console

from teleop.cli import COMMANDS, app
from teleop.cli.examples import EXAMPLES

ROOT = Path(__file__).parents[2]
FILES = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("[!.]*/README.md")]
PAGES = {str(file.relative_to(ROOT)): file.read_text(encoding="utf-8") for file in sorted(FILES)}
CODE = re.compile(r"`([^`\n]+)`")


@cache
def options() -> frozenset[str]:
    """All long options of all commands."""
    found: set[str] = set()
    for words in ((), *((name,) for name in COMMANDS), *(tuple(name.split()) for name in EXAMPLES if " " in name)):
        console = Console(width=200, color_system=None)
        with console.capture() as captured:
            app.help_print(list(words), console=console)
        found |= set(re.findall(r"--[a-z][a-z-]+", captured.get()))
    return frozenset(found)


@pytest.mark.parametrize("page", PAGES)
def test_each_is_there(page: str) -> None:
    for code in CODE.findall(PAGES[page]):
        if named := re.match(r"teleop ([a-z][a-z-]*)\b", code):
            assert named[1] in COMMANDS, code
        if code.startswith(("teleop ", "--")):
            assert set(re.findall(r"(?<!\S)--[a-z][a-z-]+", code)) <= options(), code


def test_the_options_were_found() -> None:
    assert {"--rig", "--link", "--fast", "--resume", "--tolerance", "--install-completion"} <= options()
