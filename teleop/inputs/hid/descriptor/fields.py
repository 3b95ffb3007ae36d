"""A field of an input report: where its bits are, what they mean, and which control it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from teleop.inputs.hid.descriptor.names import usage_name
from teleop.inputs.hid.descriptor.usages import Usages

VENDOR_PAGES = 0xFF00  # the first usage page of vendors


@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """One control of a report, or for an array the numbers that say which of its controls are on.

    `bit` counts from behind the report's id byte, `size` is in bits; the value is little-endian, two's complement when
    `signed`. `minimum` and `maximum` are the logical range. An array is `count` numbers of `size` bits, and has
    `usages`: number `minimum` means the first of them; its own `usage_page` and `usage` are those of the first.

    `collection` is the index of the top-level collection that it is in. `label` is its name where that is not its
    usage's, `array_names` the same of an array's controls.
    """

    report_id: int
    bit: int
    size: int
    usage_page: int
    usage: int
    minimum: int
    maximum: int
    relative: bool
    has_null: bool
    count: int = 1
    usages: Usages | None = None
    collection: int = 0
    label: str = ""
    array_names: Mapping[tuple[int, int], str] = field(default_factory=dict)

    @property
    def signed(self) -> bool:
        return self.minimum < 0

    @property
    def name(self) -> str:
        return self.label or usage_name(self.usage_page, self.usage)

    def array_name(self, page: int, usage: int) -> str:
        """The name of one control of an array."""
        return self.array_names.get((page, usage)) or usage_name(page, usage)
