"""The keys of several axes in one list of keyframes."""

from __future__ import annotations

import numpy as np

from teleop.core.axes import Axis
from teleop.recording.to_keyframes.merge_keys import AxisKey, MergedKey, merge_keys
from teleop.recording.to_keyframes.reference import Reference

LINE = Reference(np.arange(1001) / 10, [], [])  # 0.1 unit a place
PAN, TILT = Axis.PAN, Axis.TILT


def merged(pan: list[AxisKey], tilt: list[AxisKey]) -> list[MergedKey]:
    return list(merge_keys({PAN: pan, TILT: tilt}, {PAN: LINE, TILT: LINE}))


def test_keys_at_one_place_are_one_line() -> None:
    ends = [AxisKey(0, 0, 0), AxisKey(1000, 5, 0)]
    assert merged(ends, ends) == [MergedKey(0, {PAN: 0, TILT: 0}), MergedKey(1000, {PAN: 5, TILT: 5})]


def test_a_hold_that_not_all_have_is_two_stops() -> None:
    pan = [AxisKey(0, 0, 0), AxisKey(300, 1, 200), AxisKey(1000, 5, 0)]
    tilt = [AxisKey(0, 0, 0), AxisKey(300, 2, 100), AxisKey(1000, 5, 0)]
    inner = merged(pan, tilt)[1:-1]
    assert inner == [
        MergedKey(300, {PAN: 1, TILT: 2}, stop=True),
        MergedKey(400, {TILT: 2}, stop=True),
        MergedKey(500, {PAN: 1}, stop=True),
    ]


def test_a_hold_that_all_have_stays_one() -> None:
    keys = [AxisKey(0, 0, 0), AxisKey(300, 1, 200), AxisKey(1000, 5, 0)]
    assert merged(keys, keys)[1] == MergedKey(300, {PAN: 1, TILT: 1}, hold=200)


def test_a_key_passed_through_where_another_axis_stops_moves_on_along_the_recording() -> None:
    pan = [AxisKey(0, 0, 0), AxisKey(300, 30.05), AxisKey(1000, 100, 0)]
    tilt = [AxisKey(0, 0, 0), AxisKey(300, 2, 0), AxisKey(1000, 5, 0)]
    inner = merged(pan, tilt)[1:-1]
    assert [(key.place, key.stop) for key in inner] == [(300, True), (301, False)]
    assert inner[1].positions == {PAN: 30.05 + (LINE.positions[301] - LINE.positions[300])}
