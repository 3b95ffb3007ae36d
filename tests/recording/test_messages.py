"""A take read message by message: its description, its end, and files that are none."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from made_takes import LIMITS, STARTED, at_rest, write_take

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis, Limits
from teleop.recording.format import CUT, About
from teleop.recording.messages import Ending, Messages, about, ending, was_cut

ENDLESS = Limits(-math.inf, math.inf, 1, 2, 3)


def test_the_description_is_read_as_it_was_written() -> None:
    described = About("Bench", "A title", STARTED, {Axis.PAN: LIMITS, Axis.ROLL: ENDLESS}, "0.2")
    assert about(described.record()) == described


def test_another_format_is_refused_with_both_numbers() -> None:
    with pytest.raises(ValueError, match="it has format '2', this program reads '1'"):
        about({**About("", "", 0, {}, "").record(), "format": "2"})


def test_an_end_says_its_reasons() -> None:
    record = {"result": "failed", "reasons": '["a", "b"]', "dropped": "3"}
    assert str(ending(record)) == "failed: a; b"
    assert ending(record).dropped == 3
    assert str(Ending("done", (), 0)) == "done"


@pytest.mark.parametrize(("end", "cut"), [(None, True), (Ending(CUT, (), 0), True), (Ending("done", (), 0), False)])
def test_a_run_without_a_recorded_end_was_cut(end: Ending | None, cut: bool) -> None:
    assert was_cut(end) is cut


@pytest.mark.parametrize("closed", [True, False])
def test_messages_come_in_order_and_what_is_missing_is_known_after_the_last(tmp_path: Path, closed: bool) -> None:
    path = write_take(tmp_path / "t.mcap", {Axis.PAN: at_rest(1)}, 1, closed=closed)
    messages = Messages(path)
    with pytest.raises(DocumentError, match="not a take of this program"):
        _ = messages.about
    times = [line.time for line in messages if line.topic == "/motion"]
    assert times == pytest.approx([number / 100 for number in range(101)])
    assert messages.about.limits == {Axis.PAN: LIMITS}
    assert (messages.ending is not None) is closed
    assert messages.remark.startswith(f"{path}: the recording was cut off") is not closed


def test_what_cannot_be_read_is_one_line_with_its_path(tmp_path: Path) -> None:
    with pytest.raises(DocumentError) as refusal:
        list(Messages(tmp_path / "none.mcap"))
    assert refusal.value.problems == [f"{tmp_path / 'none.mcap'}: cannot be read: No such file or directory"]
