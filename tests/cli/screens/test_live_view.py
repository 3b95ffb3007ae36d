"""The live screen and its plain lines: what they say of a tick, and that they fit a terminal of 80 by 24."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from teleop.cli.screens.axis_table import axis_rows
from teleop.cli.screens.live_rows import Traffic, banner, help_rows, key_rows, state_rows, title_row
from teleop.cli.screens.live_view import LiveView, new_messages
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.keymaps import HELP, KeyReader
from teleop.manual.status import KEPT, InputStatus, Message, MessageLog, OperatorStatus

LIMITS = {
    Axis.PAN: Limits(-180, 180, 120, 240, 1200),
    Axis.TILT: Limits(-56, 146, 90, 180, 900),
    Axis.ROLL: Limits(-math.inf, math.inf, 60, 120, 600),
    Axis.FOCUS: Limits(0, 1, 0.5, 2, 10),
}
STATUS = OperatorStatus(
    inputs=[
        InputStatus("Xbox pad", [Axis.PAN], "", ""),
        InputStatus("dial", [], "hold its enable button", ""),
        InputStatus("old stick", [], "old stick: unplugged", "old stick: unplugged"),
        InputStatus("keys", [], "", ""),
    ],
    ranges=[0.1, 0.35, 1.0],
    range=1,
    stopped=False,
    manual_control=True,
    recall="",
    recall_end=0.0,
    recording=False,
    follow="lock",
    deflections={Axis.PAN: -0.5},
    presets={1: "wide", 3: ""},
    messages=[Message(5.0, "old stick: unplugged: tilt stopped")],
)
MOTION = {Axis.PAN: State(-45.0, -20.0), Axis.TILT: State(146.0), Axis.ROLL: State(370.0), Axis.FOCUS: State(0.25)}
TICK = Tick(12.0, MOTION, {}, (), {Axis.PAN: Reading(-44.5, 11.9)})


class Counts:
    def __init__(self) -> None:
        self.counts = {"frames_in": 0, "lost_replies": 0}


def screen(
    status: OperatorStatus,
    monkeypatch: pytest.MonkeyPatch,
    size: tuple[int, int] = (80, 24),
    keyboard: Keyboard | None = None,
) -> list[str]:
    """The rows of a whole screen, as they stand there."""
    monkeypatch.setenv("COLUMNS", str(size[0]))
    monkeypatch.setenv("LINES", str(size[1]))
    view = LiveView("Simulated rig", LIMITS, lambda: status, {"gimbal": Counts()}, keyboard, silent=True)
    view.observe(TICK)
    return view._picture.text().plain.split("\n")


@pytest.mark.parametrize("size", [(80, 24), (120, 40), (60, 20)])
@pytest.mark.parametrize("messages", [0, KEPT])
def test_it_fills_a_terminal_and_goes_no_further(
    monkeypatch: pytest.MonkeyPatch, size: tuple[int, int], messages: int
) -> None:
    said = [Message(float(number), f"message {number} " + "long " * 30) for number in range(messages)]
    rows = screen(replace(STATUS, messages=said), monkeypatch, size)
    assert len(rows) <= size[1]
    assert max(map(len, rows)) <= size[0]


@pytest.mark.parametrize("typed", ["?", "?f"])
@pytest.mark.parametrize("hands", [1, 4])
def test_the_help_has_every_key_on_the_smallest_terminal(
    typed: str, hands: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    reader = KeyReader()
    assert list(reader.feed(typed)) == []
    shown = screen(replace(STATUS, inputs=STATUS.inputs[:hands]), monkeypatch, keyboard=Keyboard(-1, reader))
    text = "\n".join(shown)
    assert [word for key in HELP for word in key if word not in text] == []
    assert ("follow mode?" in text) == (typed == "?f")
    assert len(shown) <= 24
    assert "-45.00" in text, "where the axes are is never hidden"


def test_it_shows_each_thing_that_an_operator_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "\n".join(screen(STATUS, monkeypatch))
    for each in (
        "Simulated rig", "-45.00", "-44.50", "-0.50", "██│", "+146.00", "+0.250", "[35%]", "Xbox pad  moves pan",
        "dial  hold its enable button", "old stick: unplugged", "not recording", "follow lock", "gimbal",
        "jog 1 deg (shift 10, ctrl 0.1)", "1 wide   3",
        "7 s ago  old stick: unplugged: tilt stopped", "Ctrl-C",
    ):  # fmt: skip
        assert each in text, each


def test_a_stop_comes_before_all_else_in_the_banner() -> None:
    everything: dict[str, Any] = {"stopped": True, "manual_control": False, "recall": "preset 1", "recall_end": 14.0}
    still = {Axis.PAN: State(-45.0)}
    assert banner(replace(STATUS, **everything), MOTION, 12.0, 80).plain.startswith(" stopping")
    stopped = " STOPPED. Press c to clear, then center all sticks."
    assert banner(replace(STATUS, **everything), still, 12.0, 80).plain.rstrip() == stopped
    everything["stopped"] = False
    assert "MANUAL CONTROL OFF" in banner(replace(STATUS, **everything), still, 12.0, 80).plain
    everything["manual_control"] = True
    assert "preset 1 in 2.0 s" in banner(replace(STATUS, **everything), still, 12.0, 80).plain
    assert banner(STATUS, still, 12.0, 80).plain == ""


def test_a_bar_shows_where_the_axis_is_and_marks_a_soft_limit() -> None:
    _, pan, tilt, roll, _ = axis_rows(TICK, LIMITS, 80, STATUS.deflections)
    bar = pan.plain[pan.plain.index("─") : pan.plain.rindex("─") + 1]
    assert bar.index("●") == pytest.approx(0.375 * (len(bar) - 1), abs=0.51)
    assert tilt.plain.index("●") > tilt.plain.rindex("─")
    assert any("yellow" in str(span.style) for span in tilt.spans)
    assert not any("yellow" in str(span.style) for span in pan.spans)
    assert "370.00" in roll.plain  # a continuous axis has turned once, and its mark is near the middle
    assert abs(roll.plain.index("●") - pan.plain.index("─") - 0.53 * len(bar)) < 2


def test_a_link_that_has_gone_silent_and_lost_replies_are_seen() -> None:
    link = Counts()
    traffic = Traffic(link)
    rows = []
    for number in range(30):
        link.counts["frames_in"] += 5
        rows.append(traffic.row("gimbal", 10 + number / 10).plain)
    assert "gimbal  50 frames/s in, 0 unanswered" in rows[-1]
    link.counts["lost_replies"] = 4
    assert "silent for 1.1 s, 4 unanswered" in traffic.row("gimbal", 14.0).plain


def test_recording_a_failing_take_and_a_question_are_shown() -> None:
    title = title_row("rig", 75.0, replace(STATUS, recording=True), "TAKE FAILED", 80).plain
    assert "● REC" in title
    assert "TAKE FAILED" in title
    assert title.rstrip().endswith("01:15")
    assert key_rows("store which preset? 0-9", True)[0].plain.strip() == "store which preset? 0-9"
    assert all(len(row.plain) <= 80 for row in [*help_rows(), *key_rows("", True), *state_rows(STATUS, [])])


def test_without_a_screen_each_message_comes_once_and_the_axes_each_second(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    status = [STATUS]
    with LiveView("Simulated rig", LIMITS, lambda: status[0], {}, None) as view:
        for number in range(250):
            if number == 120:
                status[0] = replace(STATUS, stopped=True, messages=[Message(6.0, "STOP by keys"), *STATUS.messages])
            view.observe(replace(TICK, time=10 + number / 100))
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "Simulated rig"
    assert len([line for line in lines if "pan -45.000" in line]) == 3
    assert [line.strip() for line in lines if "unplugged" in line] == ["0.0 s  old stick: unplugged: tilt stopped"]
    assert [line.strip() for line in lines if "by keys" in line] == ["1.2 s  STOP by keys"]
    assert lines[-1].endswith("stopping")  # the axes still move


def test_a_message_that_comes_again_is_the_only_one_that_is_new() -> None:
    """It takes the place of the one before: all the others were printed again with it."""
    log, printed, last = MessageLog(), list[str](), None
    for now, text in ((1.0, "first"), (2.0, "refused"), (3.0, "refused"), (3.0, "refused"), (4.0, "second")):
        log.notify(now, text)
        printed += [message.text for message in reversed(new_messages(log.messages, last))]
        last = log.messages[0]
    assert printed == ["first", "refused", "refused", "second"]
