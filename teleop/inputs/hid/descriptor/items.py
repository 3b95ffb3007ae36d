"""A report descriptor cut into its items (HID 1.11 section 6.2.2), before anything is made of them.

An item is a prefix of tag, type and size with 0, 1, 2 or 4 bytes behind it; whether these are signed depends on what
the item says, so that both readings are there. Long items (6.2.2.3) are reserved and skipped by their length.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum
from typing import NamedTuple

LONGEST = 65_535  # bytes: wDescriptorLength of the HID descriptor is 16 bits wide (6.2.1)
_LONG = 0xFE
_SIZES = (0, 1, 2, 4)


class Kind(IntEnum):
    """The type of an item, bits 2 and 3 of its prefix."""

    MAIN = 0
    GLOBAL = 1
    LOCAL = 2
    RESERVED = 3


class Item(NamedTuple):
    """`at` counts bytes from the start of the descriptor; `tag` is the upper half of the prefix."""

    at: int
    kind: Kind
    tag: int
    data: bytes

    @property
    def unsigned(self) -> int:
        return int.from_bytes(self.data, "little")

    @property
    def signed(self) -> int:
        return int.from_bytes(self.data, "little", signed=True)

    @property
    def extended(self) -> bool:
        """Whether a usage brings its page along, in its upper 16 bits (6.2.2.8)."""
        return len(self.data) == 4


def split(descriptor: bytes) -> tuple[list[Item], str]:
    """The whole items of `descriptor`, and why there are not more of them: a phrase, "" at a proper end."""
    reader = _Reader(descriptor[:LONGEST])
    items = list(reader)
    if not reader.cut and len(descriptor) > LONGEST:
        return items, f"byte {LONGEST}: longer than a descriptor can be; the rest is not read"
    return items, reader.cut


class _Reader:
    """Iterates over short items; `cut` says afterwards whether the last item was whole."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self.cut = ""

    def __iter__(self) -> Iterator[Item]:
        data, at = self._data, 0
        while at < len(data):
            prefix = data[at]
            long = prefix == _LONG
            if long and at + 2 > len(data):
                end = at + 3
            else:
                end = at + 3 + data[at + 1] if long else at + 1 + _SIZES[prefix & 3]
            if end > len(data):
                self.cut = f"byte {at}: the descriptor ends inside this item"
                return
            if not long:
                yield Item(at, Kind(prefix >> 2 & 3), prefix >> 4, data[at + 1 : end])
            at = end
