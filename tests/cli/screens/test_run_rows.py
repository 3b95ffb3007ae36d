"""The rows of a run that moves by itself: STOP first, the time in words and as a bar, keys never cut in two."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from teleop.cli.screens.run_rows import PAUSED, banner, hint_rows, note_rows, state_rows, time_words, title_row
from teleop.core.run_status import Hint, NextCue, NextKey, RunStatus
from teleop.manual.stop_guard import STOPPED, STOPPING

STATUS = RunStatus("playing", 6.5, 15.0, 8.5)


def text(rows) -> str:
    return "\n".join(row.plain for row in rows)


def test_a_stop_comes_before_a_question_and_that_before_a_pause():
    status = replace(STATUS, stop="stopping", question="frame 3 again?", paused=True)
    assert banner(status, 60).plain.strip() == STOPPING
    assert banner(replace(status, stop="stopped"), 60).plain.strip() == STOPPED
    assert banner(replace(status, stop=""), 60).plain.strip() == "frame 3 again?"
    assert banner(replace(status, stop="", question=""), 60).plain.strip() == PAUSED
    assert not banner(STATUS, 60).plain


def test_a_note_is_the_banner_of_a_pause_and_its_other_lines_stay_below():
    status = replace(STATUS, paused=True, note="paused: pad unplugged.\nplug it in")
    assert banner(status, 60).plain.strip() == "paused: pad unplugged."
    assert text(note_rows(status)) == " plug it in"
    assert text(note_rows(replace(status, paused=False))) == " paused: pad unplugged.\n plug it in"


@pytest.mark.parametrize(
    ("status", "words"),
    [
        (STATUS, "6.5 / 15.0 s, 0:08 left"),
        (replace(STATUS, left=None), "6.5 / 15.0 s"),
        (replace(STATUS, duration=math.inf, left=None), "6.5 s"),
        (replace(STATUS, elapsed=None, left=None), "0.0 / 15.0 s"),
        (replace(STATUS, total="12 of 720 frames", left=None), "12 of 720 frames"),
    ],
)
def test_the_time_in_words(status: RunStatus, words: str):
    assert time_words(status).startswith(words.partition(",")[0])
    assert ("left" in time_words(status)) == ("left" in words)


def test_a_bar_is_as_full_as_the_move_is_over_and_goes_where_there_is_no_room():
    def bar(status: RunStatus, width: int = 80) -> str:
        return state_rows(status, width)[1].plain

    half = replace(STATUS, elapsed=7.5)
    assert bar(half).count("━") == bar(half).count("─") == 15
    assert bar(replace(half, elapsed=99.0)).count("─") == 0
    assert bar(replace(half, done=0.2)).count("━") == 6
    assert "━" not in bar(replace(half, duration=math.inf))
    assert "━" not in bar(half, 30)


def test_what_comes_next_and_which_pass_it_is_are_shown_where_there_is_any():
    rows = text(state_rows(replace(STATUS, key=NextKey(3, 8.0), cue=NextCue(15.0, "stop"), passes=4, number=2), 80))
    assert "key 3 at 8.0 s, cue stop at 15.0 s" in rows
    assert "pass 2 of 4" in rows
    assert text(state_rows(replace(STATUS, passes=math.inf, number=2), 80)).endswith("pass 2")
    assert "pass" not in text(state_rows(STATUS, 80))
    assert "next" not in text(state_rows(STATUS, 80))


def test_a_long_title_gives_way_to_the_lamp():
    row = title_row("teleop play", "A title " * 20, True, "a.mcap", 60)
    assert row.cell_len <= 60
    assert "a.mcap  ● REC" in row.plain
    assert "○ REC" in title_row("teleop play", "A", None, "", 60).plain


def test_keys_fill_their_rows_and_none_is_cut():
    hints = [Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end")]
    assert text(hint_rows(hints, 80)) == " space STOP   p pause   q end"
    assert text(hint_rows(hints, 22)) == " space STOP   p pause"
    assert text(hint_rows(hints, 22, rows=2)) == " space STOP   p pause\n q end"
