"""A descriptor cut into items: their sizes, both readings of their data, and where it ends."""

from __future__ import annotations

import pytest

from teleop.inputs.hid.descriptor.items import LONGEST, Item, Kind, split


def cut(descriptor: str) -> tuple[list[Item], str]:
    return split(bytes.fromhex(descriptor))


def test_an_items_prefix_says_its_kind_its_tag_and_how_many_bytes_follow() -> None:
    assert cut("c0 8102 168000 0b30000100") == (
        [
            Item(0, Kind.MAIN, 0xC, b""),
            Item(1, Kind.MAIN, 0x8, b"\x02"),
            Item(3, Kind.GLOBAL, 0x1, b"\x80\x00"),
            Item(6, Kind.LOCAL, 0x0, b"\x30\x00\x01\x00"),
        ],
        "",
    )


@pytest.mark.parametrize(
    ("data", "unsigned", "signed", "extended"),
    [
        ("", 0, 0, False),
        ("80", 128, -128, False),
        ("ff7f", 32767, 32767, False),
        ("ffff", 65535, -1, False),
        ("feffffff", 0xFFFFFFFE, -2, True),
    ],
)
def test_data_is_little_endian_and_may_be_read_with_or_without_a_sign(
    data: str, unsigned: int, signed: int, extended: bool
) -> None:
    item = Item(0, Kind.GLOBAL, 1, bytes.fromhex(data))
    assert (item.unsigned, item.signed, item.extended) == (unsigned, signed, extended)


def test_long_items_are_skipped_by_their_length_whatever_they_hold() -> None:
    items, why = cut("fe 03 aa c0c0c0 8102")
    assert (items, why) == ([Item(6, Kind.MAIN, 0x8, b"\x02")], "")


@pytest.mark.parametrize(("descriptor", "at"), [("c0 26ff", 1), ("c0c0 0b300001", 2), ("c0 fe05aa00", 1), ("fe02", 0)])
def test_the_items_before_one_that_is_cut_off_are_whole(descriptor: str, at: int) -> None:
    items, why = cut(descriptor)
    assert [item.at for item in items] == list(range(at))
    assert why == f"byte {at}: the descriptor ends inside this item"


def test_no_more_is_read_than_a_descriptor_can_be_long() -> None:
    items, why = split(b"\xc0" * LONGEST)
    assert (len(items), why) == (LONGEST, "")
    items, why = split(b"\xc0" * (LONGEST + 1))
    assert (len(items), why) == (LONGEST, f"byte {LONGEST}: longer than a descriptor can be; the rest is not read")
