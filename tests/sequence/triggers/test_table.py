"""Triggers as they are written, and the one that is a time of day."""

import time
from datetime import datetime

import pytest

from teleop.cli.staging_options import joined
from teleop.core.errors import DeviceError, UsageError
from teleop.sequence.triggers.midi import StartTrigger, TimecodeTrigger
from teleop.sequence.triggers.osc import OscTrigger
from teleop.sequence.triggers.table import ClockTrigger, KeyTrigger, read_trigger


class Wall:
    """A wall clock that a test sets."""

    def __init__(self, text: str) -> None:
        self.now = datetime.fromisoformat(text).timestamp()

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def berlin(monkeypatch):
    monkeypatch.setenv("TZ", "Europe/Berlin")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("key", KeyTrigger),
        ("osc:9000/go", OscTrigger),
        ("osc:0.0.0.0:9000/rig/1/go", OscTrigger),
        ("mtc", StartTrigger),
        ("mtc:Tascam 1:0", StartTrigger),
        ("timecode:01:00:00:00", TimecodeTrigger),
        ("timecode:01:00:00;02@Tascam", TimecodeTrigger),
        ("time:18:30", ClockTrigger),
        ("time:8:30:15", ClockTrigger),
    ],
)
def test_each_kind_as_it_is_written(text, kind):
    assert isinstance(read_trigger(text, lambda: 0.0), kind)


@pytest.mark.parametrize(
    "text",
    [
        *("", "keys", "key:x", "osc", "osc:9000", "osc:99999/go", "osc:/go"),
        *("timecode:1:2:3", "timecode:25:00:00:00", "time", "time:24:00", "time:18:60", "time:18:30:00.5"),
    ],
)
def test_what_is_none_is_refused_with_what_would_be_right(text):
    with pytest.raises(UsageError, match=f"^--trigger {text}: (must be|is just) "):
        read_trigger(text, lambda: 0.0)


def test_two_words_are_as_good_as_one():
    assert joined(["play", "x", "--trigger", "time", "18:30:00", "--loop"]) == [
        "play",
        "x",
        "--trigger",
        "time:18:30:00",
        "--loop",
    ]
    assert joined(["--trigger", "timecode", "01:00:00:00", "x"]) == ["--trigger", "timecode:01:00:00:00", "x"]
    assert joined(["--trigger=time", "18:30", "x"]) == ["--trigger=time:18:30", "x"]
    for what in ("9000/go", "0.0.0.0:9000/go"):
        assert joined(["--trigger", "osc", what, "x"]) == ["--trigger", f"osc:{what}", "x"]
    assert joined(["--trigger", "osc", "./x.yaml"]) == ["--trigger", "osc", "./x.yaml"]
    assert joined(["--trigger", "key", "a:b"]) == ["--trigger", "key", "a:b"]
    assert joined(["play", "time", "1:2"]) == ["play", "time", "1:2"]


def test_a_time_of_day_fires_when_the_wall_clock_is_there_and_counts_down():
    wall = Wall("2026-11-25T18:29:00")
    trigger = ClockTrigger("18:30:00", wall)
    trigger.arm(0.0)
    assert trigger.waits_for(0.0) == "18:30:00, in 1 min"
    wall.now += 59.98
    assert not trigger.fired(0.0)
    wall.now += 0.02
    assert trigger.fired(0.0)
    assert not trigger.again


def test_a_time_that_is_past_is_tomorrows_and_it_says_so():
    wall = Wall("2026-12-31T18:30:00")
    assert ClockTrigger("18:30", wall).waits_for(0.0) == "18:30:00 tomorrow, in 24 h"
    assert ClockTrigger("06:15:30", wall).waits_for(0.0) == "06:15:30 tomorrow, in 11 h 45 min 30 s"


def test_a_time_that_passes_before_the_rig_is_in_place_is_no_start():
    wall = Wall("2026-11-25T18:29:58")
    trigger = ClockTrigger("18:30", wall)
    wall.now += 5
    with pytest.raises(DeviceError, match=r"18:30:00 was 3\.0 s before the rig reached the start"):
        trigger.arm(0.0)


def test_a_clock_that_is_set_decides():
    wall = Wall("2026-11-25T12:00:00")
    trigger = ClockTrigger("18:30", wall)
    trigger.arm(0.0)
    wall.now += 7 * 3600
    assert trigger.fired(0.0)
    wall.now -= 4 * 3600
    assert not trigger.fired(0.0)


def test_summer_time_begins_and_ends(berlin):
    wall = Wall("2026-03-28T23:00:00")
    assert ClockTrigger("02:30", wall).waits_for(0.0) == "02:30:00 tomorrow, in 3 h 30 min"  # at 3:30 of that day
    assert ClockTrigger("08:00", wall).waits_for(0.0) == "08:00:00 tomorrow, in 8 h"
    wall = Wall("2026-10-24T23:00:00")
    assert ClockTrigger("02:30", wall).waits_for(0.0) == "02:30:00 tomorrow, in 3 h 30 min"  # the first of two
    assert ClockTrigger("08:00", wall).waits_for(0.0) == "08:00:00 tomorrow, in 10 h"
