"""Ease as it is written, and what is said of what cannot be read."""

import pytest

from teleop.planner.keyframes.ramp import NAMES, Ramp
from teleop.sequence.easing import ease_rules, ramp, ramps


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        (1.5, Ramp(1.5)),
        ("1.5s", Ramp(1.5)),
        ("48f", Ramp(2.0)),
        ("25%", Ramp(share=0.25)),
        ("50 %", Ramp(share=0.5)),
        ("smooth", None),
        ("soft", NAMES["soft"]),
    ],
)
def test_seconds_a_share_and_a_name(written, meant):
    assert ramp(written, 24) == meant


def test_both_ends_or_each_its_own_and_what_holds_otherwise():
    everywhere = ramps("2s", None)
    assert ramps(None, None, everywhere) == (Ramp(2.0), Ramp(2.0))
    assert ramps({"arrive": "10%"}, None, everywhere) == (Ramp(share=0.1), Ramp(2.0))
    assert ramps("smooth", None, everywhere) == (None, None)


@pytest.mark.parametrize(
    ("written", "wrong"),
    [
        ("medum", "must be 1.5s, 25%, smooth, sharp, medium or soft, not 'medum'; did you mean medium?"),
        ("60%", "must be at most 50% at each end of a move, not 60%"),
        (-1, "must be 0 s or later, not -1"),
        (True, "must be 1.5s, 25%, smooth, sharp, medium or soft, not true"),
        ([1], "must be 1.5s, 25%, smooth, sharp, medium or soft, not [1]"),
        ("12f", "is 12f, in frames, which needs fps at the top of the file"),
    ],
)
def test_what_cannot_be_read(written, wrong):
    with pytest.raises(ValueError) as caught:
        ramp(written, None)
    assert str(caught.value) == wrong


def test_every_wrong_ease_of_a_file_is_named():
    data = {
        "ease": "softer",
        "keyframes": [
            {"at": 0, "pan": 0, "ease": {"leav": 1}},
            {"at": 1, "pan": 1, "ease": "1s"},
            {"at": 2, "pan": 2, "tilt": 3, "ease": {"arrive": "x%"}},
            {"at": 3, "pan": 3, "hold": 1, "ease": "1s"},
            {"at": 5, "pan": 4},
        ],
    }
    assert [place for place, _ in ease_rules(data, None)] == [
        ("ease",),
        ("keyframes", 0, "ease", "leav"),
        ("keyframes", 1, "ease"),
        ("keyframes", 2, "ease", "arrive"),
    ]
