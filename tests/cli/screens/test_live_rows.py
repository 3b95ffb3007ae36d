"""The rows of the live screen: what holds everything comes first, a silent link and an untrusted input are seen."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from teleop.cli.screens.live_rows import STALE, Traffic, banner, help_rows, key_rows, state_rows
from teleop.core.axes import Axis, State
from teleop.inputs.keymaps import HELP, NO_EMERGENCY_STOP
from teleop.manual.status import InputStatus, OperatorStatus

STATUS = OperatorStatus([], [0.1, 1.0], 0, True, True, "", 0.0, False, "", {}, {}, [])
REST = {Axis.PAN: State(0.0)}


def test_a_stop_comes_before_manual_control_and_that_before_a_recall():
    status = replace(STATUS, stopped=True, manual_control=False, recall="preset 1", recall_end=9.0)
    assert "STOP" in banner(status, REST, 5.0, 60).plain
    status = replace(status, stopped=False)
    assert "MANUAL CONTROL OFF" in banner(status, REST, 5.0, 60).plain
    status = replace(status, manual_control=True)
    assert "preset 1 in 4.0 s" in banner(status, REST, 5.0, 60).plain
    assert "preset 1 in 0.0 s" in banner(status, REST, 9.5, 60).plain
    assert not banner(replace(status, recall="", stopped=False), REST, 5.0, 60).plain


def test_a_link_without_a_frame_for_a_while_is_silent_until_the_next():
    counts = {"frames_in": 1}
    traffic = Traffic(SimpleNamespace(counts=counts))
    assert "silent" not in traffic.row("gimbal", 10.0).plain
    assert "silent" not in traffic.row("gimbal", 10.0 + STALE - 0.01).plain
    assert "silent for 0.7 s" in traffic.row("gimbal", 10.7).plain
    counts["frames_in"] = 2
    assert "silent" not in traffic.row("gimbal", 10.8).plain


def test_the_rate_of_a_link_is_that_of_the_last_whole_second():
    counts = {"frames_in": 0, "lost_replies": 0}
    traffic = Traffic(SimpleNamespace(counts=counts))
    traffic.row("gimbal", 10.0)
    counts |= {"frames_in": 100, "lost_replies": 3}
    row = traffic.row("gimbal", 12.0).plain
    assert "50 frames/s" in row
    assert "3 unanswered" in row


@pytest.mark.parametrize(
    ("hand", "shown"),
    [
        (InputStatus("pad", trouble="pad: unplugged", waits_for="x", moves=[Axis.PAN]), "pad: unplugged"),
        (InputStatus("pad", trouble="", waits_for="center the sticks", moves=[]), "pad  center the sticks"),
        (InputStatus("pad", trouble="", waits_for="", moves=[Axis.PAN, Axis.TILT]), "pad  moves pan, tilt"),
        (InputStatus("pad", trouble="", waits_for="", moves=[]), "pad  ready"),
    ],
)
def test_an_input_shows_why_it_moves_nothing_before_what_it_moves(hand: InputStatus, shown: str):
    rows = [row.plain for row in state_rows(replace(STATUS, inputs=[hand]), [])]
    assert next(row for row in rows if "inputs" in row).endswith(shown)


def test_the_speed_in_force_is_marked():
    assert "[10%]" in state_rows(STATUS, [])[0].plain
    assert "[100%]" in state_rows(replace(STATUS, range=1), [])[0].plain


def test_a_question_takes_the_place_of_the_keys_and_without_a_keyboard_there_are_none():
    assert "Ctrl-C" in key_rows("delete 1?", keys=False)[0].plain
    question, cancel = key_rows("delete 1? press d again", keys=True)
    assert (question.plain.strip(), cancel.plain.strip()) == ("delete 1? press d again", "any other key cancels")
    assert "STOP" in key_rows("", keys=True)[0].plain


def test_the_help_has_every_key_and_what_a_stop_is_not():
    text = "\n".join(row.plain for row in help_rows())
    assert all(key in text and does in text for key, does in HELP)
    assert text.rstrip().endswith(NO_EMERGENCY_STOP)
