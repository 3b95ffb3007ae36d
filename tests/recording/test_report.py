"""`teleop take report`: errors, delay and limits as they are, and no delay where the run cannot tell one."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from command import teleop
from made_takes import LIMITS, at_rest, write_take

from teleop.core.axes import Axis, Limits, State
from teleop.recording.reader import read_take
from teleop.recording.report import AxisReport, report

PAN = Axis.PAN


def swing(time: float) -> State:
    """10 deg either way in 2 pi s: V 10, A 10, J 10."""
    return State(10 * math.sin(time), 10 * math.cos(time), -10 * math.sin(time))


def evenly(time: float) -> State:
    return State(5 * time, 5.0)


def reported(folder: Path, motion=swing, measured=None, seconds: float = 13.0, limits: Limits = LIMITS) -> AxisReport:
    readings = None if measured is None else {PAN: measured}
    path = write_take(folder / "t.mcap", {PAN: motion}, seconds, measured=readings, limits={PAN: limits})
    return report(read_take(path))[PAN]


@pytest.mark.parametrize("late", [-0.02, 0.0, 0.05, 0.137, 0.4])
@pytest.mark.parametrize("grid", [0.0, 0.1])
def test_a_delay_is_found_whatever_the_grid_of_the_readings(late: float, grid: float, tmp_path: Path) -> None:
    def measured(time: float) -> float:
        place = swing(time - late).position
        return round(place / grid) * grid if grid else place

    found = reported(tmp_path, measured=measured)
    assert found.delay == pytest.approx(late, abs=0.002 if grid else 0.0011)
    assert found.untold == ""


@pytest.mark.parametrize(
    ("motion", "measured", "why"),
    [
        (at_rest(3), lambda _time: 3.0, "it did not move"),
        (swing, None, "it was not measured"),
        (swing, lambda _time: 1.0, "it hardly moved"),
        (evenly, lambda time: 5 * (time - 0.2), "its speed changed too little, or it did not follow its commands"),
        (
            evenly,
            lambda time: round(5 * (time - 0.2), 1),
            "its speed changed too little, or it did not follow its commands",
        ),
        (swing, lambda time: 0.3 * swing(time).position, "it moved 0.30 times as far as commanded"),
        (swing, lambda time: swing(time - 0.9).position, None),
    ],
)
def test_where_a_run_cannot_tell_the_delay_there_is_none(motion, measured, why: str | None, tmp_path: Path) -> None:
    found = reported(tmp_path, motion, measured)
    assert found.delay is None
    assert found.untold == (why or found.untold) != ""


def test_errors_are_by_the_readings_own_time_and_limits_by_the_ticks(tmp_path: Path) -> None:
    found = reported(
        tmp_path, measured=lambda time: swing(time).position + (0.5 if 5 < time < 5.02 or time > 20 else 0.1),
        limits=Limits(-12, 15, 20, 40, 100),
    )  # fmt: skip
    assert (found.readings, found.rms) == (326, pytest.approx(0.1, abs=0.005))
    assert (found.velocity, found.acceleration, found.jerk) == pytest.approx((0.5, 0.25, 0.1), abs=0.001)
    assert found.room == pytest.approx(2.0, abs=0.001)
    endless = reported(tmp_path / ".." / tmp_path.name, limits=Limits(-math.inf, math.inf, 20, 40, 100))
    assert (endless.room, endless.readings, math.isnan(endless.rms)) == (None, 0, True)


def test_the_command_says_it_to_people_and_programs(tmp_path: Path) -> None:
    played = teleop("play", "nudge", "--fast", "--take", "n.mcap", "--json", cwd=tmp_path)
    done = teleop("take", "report", "n.mcap", "--json", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    said, told = json.loads(done.stdout), json.loads(played.stdout)
    assert (said["title"], said["result"]) == ("Nudge", "done")
    assert said["axes"]["pan"]["rms"] == pytest.approx(told["axes"]["pan"]["rms"], abs=0.01)
    assert said["axes"]["pan"]["delay"] == pytest.approx(0.0, abs=0.02)
    for_people = teleop("take", "report", "n.mcap", cwd=tmp_path)
    assert "ended: done" in for_people.stdout
