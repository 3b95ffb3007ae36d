"""Usages of a main item: kept as ranges, handed out in their order, chosen among alternatives."""

from __future__ import annotations

import pytest

from teleop.inputs.hid.descriptor.items import Item, Kind
from teleop.inputs.hid.descriptor.usages import Local, Range, Usages

BUTTONS, DESKTOP = 0x09, 0x01


def item(number: int, size: int = 1) -> Item:
    return Item(0, Kind.LOCAL, 0, number.to_bytes(size, "little"))


@pytest.fixture
def warnings() -> list[str]:
    return []


@pytest.fixture
def local(warnings: list[str]) -> Local:
    return Local(warnings.append)


def test_a_usage_is_found_by_its_number_across_ranges() -> None:
    usages = Usages([Range(BUTTONS, 1, 3), Range(DESKTOP, 0x30, 0x30), Range(BUTTONS, 8, 9)])
    assert len(usages) == 6
    assert [usages.at(index) for index in (0, 2, 3, 4, 5)] == [
        (BUTTONS, 1),
        (BUTTONS, 3),
        (DESKTOP, 0x30),
        (BUTTONS, 8),
        (BUTTONS, 9),
    ]
    assert usages.at(6) is usages.at(-1) is None


def test_controls_beyond_the_last_usage_have_the_last() -> None:
    usages = Usages([Range(BUTTONS, 1, 2)])
    assert list(usages.of(4)) == [(BUTTONS, 1), (BUTTONS, 2), (BUTTONS, 2), (BUTTONS, 2)]
    assert list(usages.of(1)) == [(BUTTONS, 1)]
    assert list(Usages().of(4)) == []


def test_the_ends_of_a_range_make_it_in_any_order_and_then_are_used_up(local: Local, warnings: list[str]) -> None:
    local.maximum(item(4), BUTTONS)
    local.minimum(item(1), BUTTONS)
    local.minimum(item(6), BUTTONS)
    local.maximum(item(8), BUTTONS)
    assert local.close(BUTTONS).ranges == (Range(BUTTONS, 1, 4), Range(BUTTONS, 6, 8))
    assert warnings == []


def test_a_page_in_one_end_of_a_range_is_that_of_both_and_stays(local: Local, warnings: list[str]) -> None:
    local.minimum(item(BUTTONS << 16 | 1, 4), DESKTOP)
    local.maximum(item(4), DESKTOP)
    assert local.close(DESKTOP).ranges == (Range(BUTTONS, 1, 4),)
    assert warnings == []


def test_each_pair_of_delimiters_leaves_its_first_usage(local: Local, warnings: list[str]) -> None:
    for first in (0x30, 0x33):
        local.delimiter(item(1))
        local.usage(item(first), DESKTOP)
        local.usage(item(first + 1), DESKTOP)
        local.delimiter(item(0))
    local.usage(item(0x38), DESKTOP)
    assert list(local.close(DESKTOP).of(3)) == [(DESKTOP, 0x30), (DESKTOP, 0x33), (DESKTOP, 0x38)]
    assert warnings == []


def test_the_last_page_holds_for_the_usages_right_in_front_of_it_only(local: Local) -> None:
    local.usage(item(1), DESKTOP)
    local.usage(item(5), BUTTONS)
    local.usage(item(2), DESKTOP)
    assert list(local.close(BUTTONS).of(3)) == [(DESKTOP, 1), (BUTTONS, 5), (BUTTONS, 2)]
