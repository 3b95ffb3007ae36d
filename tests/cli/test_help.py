"""What `--help` shows: commands in the order of use, examples that can be typed, and what stands for a value."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator

import pytest
from cyclopts import App

from teleop.cli import COMMANDS, app, run
from teleop.cli.examples import EXAMPLES

BARE_TYPES = re.compile(r"--[a-z-]+ (?:-\w )?(STR|PATH|FLOAT|INT)\b")


def commands(of: App = app, before: str = "") -> Iterator[str]:
    """Every command with its own help, as it is typed."""
    for name in of:
        if not name.startswith("-"):
            yield f"{before} {name}".strip()
            yield from commands(of[name], f"{before} {name}")


def shown(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, command: str) -> list[str]:
    monkeypatch.setenv("COLUMNS", "80")
    assert run([*command.split(), "--help"]) == 0
    return capsys.readouterr().out.splitlines()


def test_commands_come_in_the_order_of_use(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    lines = shown(capsys, monkeypatch, "")
    names = [line.split()[1] for line in lines if line.startswith("│ ") and not line.startswith("│ -")]
    assert names == list(COMMANDS)
    assert names[:7] == ["play", "live", "console", "check", "preview", "list", "copy"]
    assert any("--install-completion" in line for line in lines)


@pytest.mark.parametrize("command", ["", *commands()])
def test_every_command_has_help_with_examples_on_80_columns(
    command: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = shown(capsys, monkeypatch, command)
    assert max(map(len, lines)) <= 80
    begin = lines.index("Examples:")
    assert [line.strip() for line in lines[begin + 1 :][: len(EXAMPLES[command])]] == list(EXAMPLES[command])
    assert not [line for line in lines if BARE_TYPES.search(line)], "a type's name says nothing"
    assert "[default: False]" not in "\n".join(lines)


def test_a_link_is_a_name_and_a_url(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    for command in ("play", "live", "send", "sim", "monitor"):
        assert any("--link NAME=URL" in line for line in shown(capsys, monkeypatch, command))


@pytest.mark.parametrize("example", [line for lines in EXAMPLES.values() for line in lines])
def test_every_example_can_be_typed(example: str) -> None:
    name, *arguments = shlex.split(example)
    assert name == "teleop"
    app.parse_args(arguments, exit_on_error=False, print_error=False)
