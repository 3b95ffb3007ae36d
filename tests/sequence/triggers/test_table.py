"""Triggers as they are written."""

import pytest

from teleop.cli.typed_triggers import joined
from teleop.core.errors import UsageError
from teleop.sequence.triggers.midi import StartTrigger, TimecodeTrigger
from teleop.sequence.triggers.osc import OscTrigger
from teleop.sequence.triggers.table import KeyTrigger, read_trigger
from teleop.sequence.triggers.time_of_day import ClockTrigger


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
