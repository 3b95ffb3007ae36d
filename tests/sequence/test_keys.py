"""From keyframes to each axis's own keys, and what a recenter adds to them."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.keys import Key
from teleop.sequence.keys import KeysError, axes_of, keys_of, recentered
from teleop.sequence.model import SequenceModel

BOUNDED = {Axis.PAN: Limits(-180, 180, 120, 240, 1200)}
TURNING = {Axis.PAN: Limits(-math.inf, math.inf, 120, 240, 1200)}
MODEL = SequenceModel.model_validate(
    {
        "fps": 25,
        "keyframes": [
            {"at": 0, "pan": 0, "focus": 0.2},
            {"at": "50f", "pan": 10, "hold": "1s", "pass": "stop"},
            {"at": "00:00:05:00", "focus": 0.8},
        ],
    }
)


def test_an_axis_has_a_key_only_where_a_keyframe_names_it() -> None:
    keys = keys_of(MODEL)
    assert list(axes_of(MODEL)) == list(keys) == [Axis.PAN, Axis.FOCUS]
    assert [(key.at, key.position, key.hold, key.stop) for key in keys[Axis.PAN]] == [
        (0, 0, 0, False),
        (2, 10, 1, True),
    ]
    assert [(key.at, key.position, key.where) for key in keys[Axis.FOCUS]] == [(0, 0.2, "key 1"), (5, 0.8, "key 3")]


@given(st.floats(-2000, 2000), st.floats(0.5, 10))
def test_a_recenter_goes_to_0_or_on_a_turning_axis_to_the_nearest_turn(position: float, duration: float) -> None:
    keys = {Axis.PAN: [Key(0, position), Key(5, position)]}
    for limits in (BOUNDED, TURNING):
        end = recentered(keys, limits, 5.0, duration, "cue 1")[Axis.PAN][-1]
        assert end.at == 5.0 + duration
        assert end.position % 360 == 0
        assert end.position == 0 or (limits is TURNING and abs(end.position - position) <= 180)


@pytest.mark.parametrize(
    ("at", "error"),
    [
        (1.0, "begins while pan moves to key 2; add `pass: stop` to key 1"),
        (2.5, "begins while key 2 holds pan (until 3 s)"),
        (3.0, "must end before key 3 (6 s), where pan is elsewhere"),
    ],
)
def test_a_recenter_needs_an_axis_that_rests_and_time_until_its_next_key(at: float, error: str) -> None:
    pan = [Key(0, 0, where="key 1"), Key(2, 10, True, 1.0, "key 2"), Key(6, 20, where="key 3")]
    with pytest.raises(KeysError) as raised:
        recentered({Axis.PAN: [Key(-1, -5, where="key 0"), *pan]}, BOUNDED, at, 4.0, "cue 1")
    assert str(raised.value) == error


def test_axes_that_no_recenter_moves_keep_their_keys() -> None:
    focus = [Key(0, 0.2), Key(5, 0.8)]
    assert recentered({Axis.FOCUS: focus}, BOUNDED, 5.0, 1.0, "cue 1") == {Axis.FOCUS: focus}
