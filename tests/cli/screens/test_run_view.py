"""The views of runs that move by themselves: drawable at any moment and size, and what they say of a STOP."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from teleop.cli.screens.axis_table import LONGEST, axis_rows, columns, number
from teleop.cli.screens.live_view import LiveView
from teleop.cli.screens.picture import Picture, Rows
from teleop.cli.screens.run_rows import hint_rows
from teleop.cli.screens.run_view import RunView, timed
from teleop.cli.screens.shoot_view import ShootView, free
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Action, Tick
from teleop.core.run_status import Hint, NextCue, NextKey, RunStatus, StopState, stop_state
from teleop.core.setpoints import StateTarget, Stop
from teleop.manual.status import OperatorStatus
from teleop.timelapse.progress import Progress
from teleop.timelapse.schedule import Schedule

LIMITS = {axis: Limits(-180, 180, 120, 240, 1200) for axis in Axis}
HINTS = (Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end"), Hint("- +", "speed"))
STATUS = RunStatus(
    "playing", 6.5, 15.0, 8.5, NextKey(3, 8.0), NextCue(15.0, "stop"), recording=True, hints=HINTS, note="a note"
)
MOVING = {Axis.PAN: State(-45.0, -20.0), Axis.TILT: State(14.0), Axis.STICK_THROTTLE: State(0.5)}
RESTING = {axis: State(state.position) for axis, state in MOVING.items()}
DEMAND = {axis: StateTarget(*state) for axis, state in MOVING.items()}
HALT = {axis: Stop() for axis in MOVING}
TICK = Tick(12.0, MOVING, DEMAND, (), {Axis.PAN: Reading(-44.5, 11.9)})


def views(status: RunStatus = STATUS) -> dict[str, RunView | LiveView]:
    progress = Progress(Schedule(1.0, 1.0, 12), 24.0)
    operator = OperatorStatus([], [0.1, 1.0], 0, True, True, "", 0.0, False, "", {}, {}, [])
    return {
        "play": RunView("A title that goes on and on, beyond any terminal", LIMITS, lambda _now: status),
        "sticks": RunView("Sticks", LIMITS, timed(lambda: math.inf, math.inf, "replaying")),
        "shoot": ShootView("Dusk", LIMITS, Path(), progress, False, True),
        "live": LiveView("Rig", LIMITS, lambda: operator, {}, None),
    }


@pytest.mark.parametrize("name", views())
@pytest.mark.parametrize("ticked", [False, True])
@pytest.mark.parametrize("stop", ["", "stopping", "stopped"])
def test_any_view_is_drawn_at_any_moment_and_size(
    name: str, ticked: bool, stop: StopState, monkeypatch: pytest.MonkeyPatch
) -> None:
    for width in (20, 21, 30, 37, 40, 57, 60, 79, 80, 81, 120, 200):
        for height in (5, 6, 8, 11, 12, 24, 50):
            monkeypatch.setenv("COLUMNS", str(width))
            monkeypatch.setenv("LINES", str(height))
            view = views(replace(STATUS, stop=stop))[name]
            if ticked:
                view.observe(TICK)
            rows = view._picture.text().plain.split("\n")
            assert len(rows) == height
            assert max(map(len, rows)) <= width
            assert "cannot draw" not in "\n".join(rows)
            assert rows[-1].strip(), "the key line"
            if ticked:
                cut = columns(TICK, width, False).names
                least = len(MOVING) + 2 + (stop != "") * (name == "play")  # with the title and the keys
                assert height < least or [axis for axis in MOVING if f" {axis[:cut]}" not in str(rows)] == []


@given(
    width=some.integers(20, 220),
    position=some.floats(-1e4, 1e4),
    axes=some.sets(some.sampled_from(Axis), min_size=1),
    deflected=some.booleans(),
)
@settings(max_examples=150)
def test_a_narrow_terminal_loses_columns_and_never_rows(
    width: int, position: float, axes: set[Axis], deflected: bool
) -> None:
    motion = {axis: State(position) for axis in sorted(axes)}
    tick = Tick(1.0, motion, {}, (), {axis: Reading(position, 1.0) for axis in motion if not axis.is_stick})
    rows = axis_rows(tick, LIMITS, width, {} if deflected else None)
    assert len(rows) == 1 + len(axes)
    assert len({len(row.plain) for row in rows[1:]}) == 1, "its columns stand below each other"
    assert len(rows[1].plain) <= width
    assert rows[1].plain.count("─") <= LONGEST
    for axis, row in zip(motion, rows[1:], strict=True):
        assert number(axis, position) in row.plain, "where it is commanded to be is what stays"


def test_angles_have_two_decimals_and_all_else_three() -> None:
    assert [number(axis, -1e-9) for axis in (Axis.PAN, Axis.ROLL, Axis.FOCUS)] == ["+0.00", "+0.00", "+0.000"]
    heading, pan, _, stick = (row.plain for row in axis_rows(TICK, LIMITS, 80))
    assert heading.split() == ["axis", "commanded", "measured", "error"]
    assert pan.split()[-3:] == ["-45.00", "-44.50", "-0.50"]
    assert stick.split()[-3:] == ["+0.500", "-", "-"]


def test_the_keys_are_cut_between_two_and_never_in_one() -> None:
    shown = [hint_rows(HINTS, width)[0].plain.strip() for width in range(20, 60)]
    whole = ["   ".join(f"{key} {does}" for key, does in HINTS[:count]) for count in range(1, 5)]
    assert set(shown) == set(whole)
    assert shown[-1].endswith("- + speed")


def seen(view: RunView) -> str:
    return view._picture.text().plain


def display(status: Callable[[], RunStatus] = lambda: STATUS) -> RunView:
    return RunView("Slow reveal", LIMITS, lambda _now: status())


def test_it_shows_all_that_an_operator_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("LINES", "24")
    view = display()
    view.observe(TICK)
    text = seen(view)
    for each in (
        "Slow reveal", "● REC", "playing", "6.5 / 15.0 s, 8.5 s left", "key 3 at 8.0 s", "cue stop at 15.0 s", "100%",
        "a note", "space STOP   p pause   q end   - + speed",
    ):  # fmt: skip
        assert each in text, each


def test_the_lamp_is_what_the_camera_was_told() -> None:
    view = display(lambda: replace(STATUS, recording=None))
    for number_, (act, lamp) in enumerate([(None, "○ REC"), (Action.RECORD, "● REC"), (Action.STOP, "○ REC")]):
        view.observe(replace(TICK, time=12.0 + number_, actions=() if act is None else (act,)))
        assert lamp in seen(view)


def test_a_stop_is_said_to_be_one_only_once_the_axes_rest() -> None:
    assert [stop_state(True, motion) for motion in (MOVING, RESTING)] == ["stopping", "stopped"]
    assert stop_state(False, RESTING) == ""
    status = replace(STATUS, stop="stopping", note="")
    view = display(lambda: status)
    view.observe(TICK)
    assert " stopping: " in seen(view)
    assert "STOPPED" not in seen(view)
    status = replace(status, stop="stopped")
    view.observe(replace(TICK, time=13.0, motion=RESTING))
    assert "STOPPED. Press c to clear, q to end." in seen(view)


def test_a_run_that_is_ended_in_mid_move_is_stopping_and_then_stopped(capsys: pytest.CaptureFixture[str]) -> None:
    view = display()
    with view:
        view.observe(TICK)
        for step in range(3):
            view.observe(replace(TICK, time=12.01 + step / 100, demand=HALT))
        assert "stopping" in seen(view)
        view.observe(replace(TICK, time=12.05, demand=HALT, motion=RESTING))
        view.observe(replace(TICK, time=12.15, demand=HALT, motion=RESTING))
        assert "STOPPED" in seen(view)
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if line in ("stopping", "STOPPED")] == ["stopping", "STOPPED"]
    assert lines[0] == "Slow reveal"
    assert lines[1].startswith("   6.5 / 15.0 s  pan   -45.00")


def test_a_run_that_ends_at_rest_was_not_stopped() -> None:
    view = display()
    view.observe(TICK)
    view.observe(replace(TICK, time=13.0, demand=HALT, motion=RESTING))
    assert "STOP" not in seen(view).replace("space STOP", "")


def test_a_picture_that_cannot_be_made_is_a_line_and_stops_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(width: int, height: int) -> Rows:
        raise ZeroDivisionError(f"{width}x{height}")

    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("LINES", "24")
    text = Picture(broken).text().plain
    assert text.splitlines()[0].rstrip() == "cannot draw the view (ZeroDivisionError: 80x24); the run continues"


def test_a_folder_that_is_gone_ends_no_shoot(tmp_path: Path) -> None:
    assert free(tmp_path) > 0
    assert free(tmp_path / "gone") == 0
