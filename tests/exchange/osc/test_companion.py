"""The page for Companion: in its published format; each button sends a command, and is lit by what the rig sends."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from teleop.core.axes import Axis
from teleop.door.messages import checked
from teleop.exchange.osc.commands import command
from teleop.exchange.osc.feedback import Feedback
from teleop.links.osc_packets import Message, messages

ROOT = Path(__file__).parents[3]
PAGE = json.loads((ROOT / "docs" / "how-to" / "teleop.companionconfig").read_text(encoding="utf-8"))
BUTTONS = [
    pytest.param(button, id=button["style"]["text"])
    for row in PAGE["page"]["controls"].values()
    for button in row.values()
]
SHOWN = {"measured": 1.0, "measured_age_ms": 1.0}
FLAGS = {"stopped": False, "recording": False, "holder": None, "move": None}
STATE = {"age_ms": 1.0, "axes": {"pan": SHOWN}, **FLAGS}


def argument(word: str) -> int | float | str:
    """As generic-osc reads a word of its arguments."""
    if word.startswith('"'):
        return word.strip('"')
    return float(word) if "." in word else int(word)


def test_it_is_a_page_as_companion_exports_one():
    """`ExportPageModelv4` of Companion; a connection without a label would be left out."""
    assert (PAGE["version"], PAGE["type"], PAGE["oldPageNumber"]) == (4, "page", 1)
    grid = PAGE["page"]["gridSize"]
    for row, buttons in PAGE["page"]["controls"].items():
        assert grid["minRow"] <= int(row) <= grid["maxRow"]
        assert all(grid["minColumn"] <= int(column) <= grid["maxColumn"] for column in buttons)
    (connection,) = PAGE["instances"].values()
    assert connection["instance_type"] == "generic-osc"
    assert connection["label"]
    assert {"host", "targetPort", "protocol", "listen", "feedbackPort"} <= set(connection["config"])


@pytest.mark.parametrize("button", BUTTONS)
def test_a_button_sends_a_command_and_is_lit_by_a_message_of_the_rig(button: dict[str, Any]):
    (action,) = button["steps"]["0"]["action_sets"]["down"]
    assert not button["steps"]["0"]["action_sets"]["up"]
    assert action["instance"] in PAGE["instances"]
    assert action["action"] in ("send_blank", "send_multiple")
    words = action["options"].get("arguments", "").split()
    asked = command(Message(action["options"]["path"], tuple(argument(word) for word in words)), tuple(Axis))
    assert asked is not None
    checked({**asked, "id": 1, "session": "s"})
    sent = {message.address: message.arguments for data in Feedback().due(STATE, 0.0) for message in messages(data)}
    for feedback in button["feedbacks"]:
        assert feedback["type"] == "osc_feedback_int"
        assert isinstance(sent[feedback["options"]["path"]][0], int)


def test_the_file_is_that_of_its_maker():
    made = subprocess.run([sys.executable, str(ROOT / "docs" / "make_companion.py"), "--check"], timeout=100)
    assert made.returncode == 0, "python docs/make_companion.py"


def test_ids_are_unique():
    found = [each["id"] for param in BUTTONS for each in _parts(param.values[0])]
    assert len(found) == len(set(found))


def _parts(button: Any) -> list[dict[str, Any]]:
    return [*button["feedbacks"], *button["steps"]["0"]["action_sets"]["down"]]
