"""The text of a fitted sequence: read back it is the same, and nothing of a title is YAML."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.recording.to_keyframes.merge_keys import MergedKey
from teleop.recording.to_keyframes.sequence_text import SequenceText, sequence_text

FRAMES = [
    MergedKey(0, {Axis.PAN: -0.0001, Axis.FOCUS: 0.25}),
    MergedKey(150, {Axis.PAN: 10.04}, stop=True),
    MergedKey(300, {Axis.PAN: 20.0}, hold=50),
]
DIGITS = {Axis.PAN: 1, Axis.FOCUS: 3}


def test_a_keyframe_is_a_line_with_no_more_digits_than_mean_something() -> None:
    text = sequence_text(SequenceText("Night", 0.5, FRAMES, [(1.5, Action.RECORD)], DIGITS))
    assert text.splitlines() == [
        'title: "Night"',
        "tension: 0.5",
        "keyframes:",
        "  - {at: 0, pan: 0, focus: 0.25}",
        "  - {at: 1.5, pan: 10, pass: stop}",
        "  - {at: 3, pan: 20, hold: 0.5s}",
        "cues:",
        "  - {at: 1.50, camera: record}",
    ]


@given(st.text())
def test_any_title_is_read_back(title: str) -> None:
    text = sequence_text(SequenceText(title, 0.0, FRAMES, [], DIGITS))
    assert yaml.safe_load(text)["title"] == title


@pytest.mark.parametrize("place", [0, 1, 99, 100, 12345])
def test_places_are_hundredths_of_a_second(place: int) -> None:
    text = sequence_text(SequenceText("t", 0.0, [MergedKey(place, {Axis.PAN: 1.0})], [], DIGITS))
    assert yaml.safe_load(text)["keyframes"] == [{"at": place / 100, "pan": 1}]
