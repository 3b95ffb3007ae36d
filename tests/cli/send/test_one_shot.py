"""What is printed of one command."""

from __future__ import annotations

import json

import pytest

from teleop.cli.send.one_shot import tell
from teleop.core.errors import DeviceError

RECORD = {"message": "gimbal.recenter", "reply": True}


def test_a_command_that_was_done_prints_its_lines_or_its_record(capsys):
    tell("recenter", RECORD, "", ["done", "twice"], as_json=False)
    assert capsys.readouterr().out == "done\ntwice\n"
    tell("recenter", RECORD, "", ["done"], as_json=True)
    assert json.loads(capsys.readouterr().out) == RECORD


@pytest.mark.parametrize("as_json", [True, False])
def test_a_refusal_is_an_error_and_never_looks_done(capsys, as_json):
    with pytest.raises(DeviceError, match="recenter was refused: it failed"):
        tell("recenter", RECORD, "it failed", ["done"], as_json)
    assert "done" not in capsys.readouterr().out
