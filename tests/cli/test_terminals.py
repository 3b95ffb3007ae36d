"""What a user sees on a real terminal of every command that draws: no traceback, no wrapped row, the keys in place."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path

import pytest
from command import teleop
from terminal_screen import SIZES, TerminalScreen, screen, screens

SHORT = """
title: Short
keyframes:
  - {at: 0,  pan: 0, tilt: 0, focus: 0.2}
  - {at: 2s, pan: 6, tilt: 2}
  - {at: 4s, pan: 0, tilt: 0, focus: 0.4}
cues:
  - {at: 0, camera: record}
  - {at: 3.5s, camera: stop}
"""
DUSK = """
title: Dusk
fps: 24
keyframes:
  - {at: 0, pan: -2}
  - {at: 5, pan: 2}
timelapse: {frames: 6, interval: 1s, exposure: 0.1s}
"""
SIZED = pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
KEYS = "space STOP"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "short.yaml").write_text(SHORT)
    (tmp_path / "dusk.yaml").write_text(DUSK)
    return tmp_path


def elapsed(rows: Sequence[str]) -> float:
    """How far a move is, in s, as it is on the screen; -1 before it begins."""
    return max([float(found[1]) for row in rows if (found := re.search(r"([0-9.]+) / [0-9.]+ s, ", row))], default=-1.0)


def past(seconds: float) -> Callable[[Sequence[str]], bool]:
    return lambda rows: elapsed(rows) > seconds


def an_axis(rows: Sequence[str], axis: str) -> str:
    return next(row for row in rows if row.startswith(f" {axis} "))


def look_at_a_move(term: TerminalScreen, middle: float, axes: Sequence[str]) -> None:
    rows = term.wait_until(past(middle), f"{middle} s of the move")
    term.look(rows, key_line=KEYS)
    for heading in ("commanded", "measured", "error"):
        assert heading in "\n".join(rows)
    for axis in axes:
        assert re.search(r"[+-]\d+\.\d\d+ +[+-]\d+\.\d\d+ +[+-]\d+\.\d\d+", an_axis(rows, axis))
    assert re.search(r"[+-]\d+\.\d\d ", an_axis(rows, axes[0])), "angles have two decimals"
    shown = "\n".join(rows)
    for each in ("REC", " s left", "speed", "100%", "next", "key "):
        assert each in shown, f"{each!r}:\n{shown}"


def look_at_its_end(term: TerminalScreen) -> None:
    assert term.end() == 0, term.text
    term.look()
    assert any("Commanded against measured" in row for row in term.rows), term.text
    assert not any(KEYS in row for row in term.rows), "keys that do nothing any more"


def test_the_first_command(folder: Path) -> None:
    with screens("play", "reveal", folder=folder) as terms:
        for term in terms:
            look_at_a_move(term, 6, ["pan", "tilt", "focus"])
        for term in terms:
            look_at_its_end(term)


def test_the_first_shoot(folder: Path) -> None:
    with screens("play", "dusk.yaml", folder=folder) as terms:
        for term in terms:
            rows = term.wait_until(lambda rows: re.search("[2-5] of 6 frames", "\n".join(rows)), "the second frame")
            term.look(rows, key_line=KEYS)
            assert re.search(r"[+-]\d+\.\d\d +[+-]\d+\.\d\d +[+-]\d+\.\d\d", an_axis(rows, "pan"))
            for each in (" left", "clip ", "GB free", "REC"):
                assert any(each in row for row in rows), f"{each}: {rows}"
        for term in terms:
            assert term.end() == 0, term.text
            term.look()
            assert any("6 of 6 frames shot" in row for row in term.rows)


def test_the_first_calibration(folder: Path) -> None:
    with screens("calibrate", "delay", folder=folder) as terms:
        for term in terms:
            rows = term.wait_until(past(3), "3 s of the test move")
            term.look(rows)
            assert rows[-1].strip(), "its keys"
            assert re.search(r"[+-]\d+\.\d\d +[+-]\d+\.\d\d +[+-]\d+\.\d\d", an_axis(rows, "pan"))
            term.type("x" * 300)  # what is typed, and echoed, may not scroll it
            later = elapsed(rows) + 2
            back = lambda rows, later=later: elapsed(rows) > later and rows[0].startswith(" teleop")  # noqa: E731
            term.wait_until(back, "the view again")
            term.screen.wrapped.clear()
        for term in terms:
            assert term.end() == 0, term.text
            term.look()
            assert any("for the gimbal among the sinks" in row for row in term.everything)


@SIZED
def test_the_first_hand(size: tuple[int, int], folder: Path) -> None:
    take = str(folder / "shot.mcap")
    with screen("live", "--take", take, folder=folder, size=size, cwd=folder) as term:
        term.wait_for_keys()
        rows = term.wait_for("measured")
        term.look(rows)
        assert KEYS in "\n".join(rows[-2:]), rows
        for each in ("follow not set", "jog 1 deg", "take "):
            assert any(each in row for row in rows), f"{each}:\n{term.text}"
        term.type("r")
        term.wait_for("camera: recording")
        term.wait_for("● REC")
        term.type(".")
        term.wait_for("camera: shutter released")
        term.type("fl")
        term.wait_until(lambda rows: any(row.endswith("follow lock") for row in rows), "the follow mode")
        term.type("L ")
        term.wait_for("STOPPED. Press c to clear, then center all sticks.")
        term.look(term.rows)
        term.type("?")
        term.look(term.wait_for("STOP is not an emergency stop: the motors stay powered."))
        assert any(row.startswith(" pan ") for row in term.rows), "where the axes are is never hidden"
        term.type("?cq")
        assert term.end() == 0, term.text
        term.look()


@SIZED
def test_a_report_and_a_list_of_takes(size: tuple[int, int], folder: Path) -> None:
    with screen("play", "short.yaml", "--fast", "--take", "a.mcap", folder=folder, size=size, cwd=folder) as term:
        assert term.end() == 0, term.text
        term.look()
    for arguments, heading in ((["report", "a.mcap"], "RMS"), (["list", "."], "Recorded"), (["info", "a.mcap"], "pan")):
        with screen("take", *arguments, folder=folder, size=size, cwd=folder) as term:
            assert term.end() == 0, term.text
            term.look()
            assert any(heading in row for row in term.rows), term.text


@SIZED
@pytest.mark.parametrize(
    ("arguments", "busy"),
    [
        (["preview", "interview", "--csv", "out.csv", "--rate", "400"], "Writing"),
        (["take", "keyframes", "a.mcap", "-o", "keys.yaml"], ""),
        (["take", "export", "a.mcap", "--csv", "out.csv"], ""),
        (["check", "reveal"], ""),
        (["play", "short.yaml", "--passes", "2", "--fast"], ""),
        (["devices"], ""),
        (["doctor"], ""),
    ],
)
def test_what_takes_time_and_what_prints_a_table(
    arguments: list[str], busy: str, size: tuple[int, int], folder: Path
) -> None:
    if "a.mcap" in arguments:
        assert teleop("play", "short.yaml", "--fast", "--take", "a.mcap", cwd=folder).returncode == 0
    with screen(*arguments, folder=folder, size=size, cwd=folder) as term:
        if busy:
            term.look(term.wait_for(busy))
        assert term.end() in (0, 1), term.text
        if arguments != ["doctor"]:  # whose lines are to be copied, and are as long as they are
            term.look()
        assert "Traceback" not in "\n".join(term.everything)


def test_the_spinner_of_a_fit_is_shown_and_taken_away(folder: Path) -> None:
    assert teleop("play", "short.yaml", "--fast", "--take", "a.mcap", cwd=folder).returncode == 0
    with screen("take", "keyframes", "a.mcap", "-o", "keys.yaml", folder=folder, size=(80, 24), cwd=folder) as term:
        assert term.end() == 0, term.text
        term.look()
        assert b"Fitting" in term.raw
        assert "Fitting" not in "\n".join(term.everything)
        assert "keys.yaml: " in term.text


def test_the_status_line_of_monitor_is_one_row_and_becomes_the_summary(folder: Path) -> None:
    link = "gimbal=udp_multicast:239.74.163.77"
    with screen("monitor", "--link", link, "--seconds", "2", folder=folder, size=(80, 24), cwd=folder) as term:
        term.look(term.wait_for("0 of other ids"))
        assert term.end() == 0, term.text
        term.look()
        assert term.text.count("0 frames to the gimbal") == 1


ODD = {
    "dumb": ((80, 24), {"TERM": "dumb"}),
    "no colour": ((80, 24), {"NO_COLOR": "1"}),
    "no colour, dumb": ((80, 24), {"NO_COLOR": "1", "TERM": "dumb"}),
    "ascii": ((80, 24), {"LC_ALL": "C", "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}),
    "posix": ((80, 24), {"LC_ALL": "POSIX", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}),
    "small": ((40, 12), {}),
    "smallest": ((20, 5), {}),
    "wide": ((200, 50), {}),
    "unknown": ((80, 24), {"TERM": "what-is-this"}),
    "no term": ((80, 24), {"TERM": None}),
}


def look_at_an_odd_one(odd: str, term: TerminalScreen) -> None:
    rows = term.wait_until(lambda rows: any("pan" in row for row in rows), "the axes")
    if "dumb" not in odd:
        term.look(rows, key_line=KEYS)
        assert "commanded" in "\n".join(rows)
    if odd == "ascii":
        assert all(row.isascii() for row in rows), rows
    if odd == "no colour":
        assert b"\x1b[31m" not in term.raw
        assert b"\x1b[32m" not in term.raw
    if odd == "wide":
        assert max(row.count("─") + row.count("━") for row in rows) <= 60, "a bar across the room"


@pytest.mark.parametrize("three", [list(ODD)[first::3] for first in range(3)], ids=", ".join)
def test_odd_terminals_are_drawn_on_all_the_same(three: list[str], folder: Path) -> None:
    """Three at once: what they wait for is time."""
    (folder / "short.yaml").write_text(SHORT.replace("Short", "Schnee über Zürich ☃"))
    with ExitStack() as stack:
        terms = {}
        for odd in three:
            size, environment = ODD[odd]
            opened = screen("play", "short.yaml", folder=folder, size=size, environment=environment, cwd=folder)
            terms[odd] = stack.enter_context(opened)
        for odd, term in terms.items():
            look_at_an_odd_one(odd, term)
        for odd, term in terms.items():
            assert term.end() == 0, (odd, term.text)
            term.look()


def test_a_window_that_changes_its_size_meanwhile(folder: Path) -> None:
    with screen("play", "reveal", folder=folder, cwd=folder) as term:
        term.wait_until(past(0.2), "the move")
        for size in ((50, 16), (30, 9), (110, 30)):
            term.resize(*size)
            rows = term.wait_until(lambda rows: rows[-1].startswith(f" {KEYS}"), "its keys at the new bottom")
            term.screen.wrapped.clear()  # what was on its way when the window changed
            term.look(term.wait_until(past(elapsed(rows)), "it drawn again"), key_line=KEYS)
        rows = term.wait_until(lambda rows: any("error" in row for row in rows), "all columns again")
        assert any(row.startswith(" focus") for row in rows)
        term.type("q")
        assert term.end() == 130, term.text
        term.look()


def test_a_signal_in_mid_move_leaves_the_terminal_as_it_was(folder: Path) -> None:
    with screen("play", "reveal", folder=folder, cwd=folder) as term:
        term.wait_until(past(2), "the move")
        term.type("\x03")
        assert term.end() == 130
        term.look()
        assert any("teleop: stopped: SIGINT received" in row for row in term.rows), term.text
        assert term.raw.rstrip().count(b"\x1b[?1049l") == 1
