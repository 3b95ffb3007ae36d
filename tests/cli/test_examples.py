"""The examples below each command's help."""

from __future__ import annotations

import pytest

from teleop.cli import COMMANDS
from teleop.cli.examples import EXAMPLES, examples


@pytest.mark.parametrize("command", EXAMPLES)
def test_every_example_begins_with_its_command(command):
    assert examples(command).startswith("Examples:\n  teleop ")
    assert all(line.startswith(f"teleop {command}".rstrip()) for line in EXAMPLES[command])


def test_every_command_has_examples():
    assert set(COMMANDS) <= set(EXAMPLES)
