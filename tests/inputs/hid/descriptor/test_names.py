"""Names of usages: what a profile's mapping is written in."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.inputs.hid.descriptor.names import PAGES, USAGES, usage_name


@pytest.mark.parametrize(
    ("page", "usage", "name"),
    [
        (0x01, 0x30, "X"),
        (0x01, 0x35, "Rz"),
        (0x01, 0x36, "Slider"),
        (0x01, 0x37, "Dial"),
        (0x01, 0x38, "Wheel"),
        (0x01, 0x39, "Hat switch"),
        (0x01, 0x93, "D-pad left"),
        (0x02, 0xBA, "Rudder"),
        (0x02, 0xBB, "Throttle"),
        (0x02, 0xC4, "Accelerator"),
        (0x02, 0xC8, "Steering"),
        (0x05, 0x37, "Gamepad fire/jump"),
        (0x07, 0x04, "Key A"),
        (0x07, 0x27, "Key 0"),
        (0x07, 0x45, "Key F12"),
        (0x07, 0x52, "Key up"),
        (0x07, 0x62, "Keypad 0"),
        (0x07, 0x73, "Key F24"),
        (0x07, 0xE7, "Right GUI"),
        (0x09, 1, "Button 1"),
        (0x09, 0x7F, "Button 127"),
        (0x0C, 0xB2, "Record"),
        (0x0C, 0xCD, "Play/pause"),
        (0x0C, 0xE9, "Volume increment"),
        (0x0C, 0x223, "AC home"),
        (0x0D, 0x42, "Tip switch"),
        (0x0D, 0x33, "Touch"),
        (0xFF00, 0x20, "Vendor 0xff00:0x20"),
        (0x01, 0x9F, "Generic desktop 0x1:0x9f"),
        (0x09, 0, "Button 0x9:0x0"),
        (0x77, 0x31, "Page 0x77:0x31"),
    ],
)
def test_names(page: int, usage: int, name: str) -> None:
    assert usage_name(page, usage) == name


def test_a_name_stands_for_one_usage() -> None:
    counted = Counter(name for usages in USAGES.values() for name in usages.values())
    assert [name for name, times in counted.items() if times > 1] == []
    assert set(USAGES) <= set(PAGES)


@given(*[st.tuples(st.integers(0, 0xFFFF), st.integers(0, 0xFFFF))] * 2)
def test_no_two_usages_share_a_name(one: tuple[int, int], other: tuple[int, int]) -> None:
    assert (usage_name(*one) == usage_name(*other)) == (one == other)
