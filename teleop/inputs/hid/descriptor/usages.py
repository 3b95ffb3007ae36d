"""Which usages the controls of one main item have: what local items leave behind (HID 1.11 section 6.2.2.8).

Usages are kept as ranges, since a range may be 65536 long and is declared in six bytes. Three rules meet here:

* A usage of four bytes brings its page along. A shorter one takes the page in force, and when a page is declared
  behind the last usage, that one holds for the usages in front of it: "the last declared page" of the document, by
  which real keyboards declare theirs. Usages of another page in between keep their own, as in Linux.
* Usages between delimiters are alternatives for one control, the first the most preferred; the others are left out.
* Controls beyond the last usage have the last usage.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from itertools import accumulate, chain, islice, repeat
from typing import NamedTuple

from teleop.inputs.hid.descriptor.items import Item

Warn = Callable[[str], None]


class Range(NamedTuple):
    """Usages `first` to `last` of a page, both included."""

    page: int
    first: int
    last: int

    @property
    def usages(self) -> range:
        return range(self.first, self.last + 1)


class Usages:
    """Usages in the order in which a main item hands them out: to its controls, or to the numbers of an array."""

    def __init__(self, ranges: Iterable[Range] = ()) -> None:
        self.ranges = tuple(ranges)
        self._starts = list(accumulate((len(each.usages) for each in self.ranges), initial=0))

    def __len__(self) -> int:
        return self._starts[-1]

    def at(self, index: int) -> tuple[int, int] | None:
        """Page and usage number `index`, None when there are not so many."""
        if not 0 <= index < len(self):
            return None
        place = bisect_right(self._starts, index) - 1
        return self.ranges[place].page, self.ranges[place].usages[index - self._starts[place]]

    def of(self, controls: int) -> Iterator[tuple[int, int]]:
        """Page and usage of so many controls; none when there are no usages."""
        declared = ((each.page, usage) for each in self.ranges for usage in each.usages)
        last = repeat((self.ranges[-1].page, self.ranges[-1].last)) if self.ranges else ()
        return islice(chain(declared, last), controls)


class _Declared(NamedTuple):
    range: Range
    extended: bool
    alternative: bool


class Local:
    """The usage items since the last main item; the other local items (designators, strings) say nothing to us."""

    def __init__(self, warn: Warn) -> None:
        self._warn = warn
        self._declared: list[_Declared] = []
        self._minimum: Item | None = None
        self._maximum: Item | None = None
        self._delimited = False
        self._chosen = False  # whether the delimiters that are open have their usage already

    def usage(self, item: Item, page: int) -> None:
        number = item.unsigned
        self._declare(Range(number >> 16 if item.extended else page, number & 0xFFFF, number & 0xFFFF), item.extended)

    def minimum(self, item: Item, page: int) -> None:
        self._minimum = item
        self._pair(page)

    def maximum(self, item: Item, page: int) -> None:
        self._maximum = item
        self._pair(page)

    def delimiter(self, item: Item) -> None:
        opens = item.unsigned == 1
        if opens == self._delimited:
            self._warn("a delimiter inside a delimiter" if opens else "a delimiter closed that was not open")
        self._delimited, self._chosen = opens, False

    def close(self, page: int) -> Usages:
        """What was declared when a main item comes while `page` is in force."""
        if self._minimum:
            self._warn("a usage minimum without a maximum; left out")
        elif self._maximum:
            self._warn("a usage maximum without a minimum; taken from 0, as Linux does")
            self._declare(Range(page, 0, self._maximum.unsigned & 0xFFFF), extended=False)
        declared = self._declared
        for place in reversed(range(len(declared))):
            usages, extended, alternative = declared[place]
            if extended:
                continue
            if usages.page == page:
                break
            declared[place] = _Declared(usages._replace(page=page), extended, alternative)
        return Usages(each.range for each in declared if not each.alternative)

    def _pair(self, page: int) -> None:
        if self._minimum is None or self._maximum is None:
            return
        low, high = self._minimum, self._maximum
        self._minimum = self._maximum = None
        pages = {item.unsigned >> 16 for item in (low, high) if item.extended} or {page}
        usages = Range(pages.pop(), low.unsigned & 0xFFFF, high.unsigned & 0xFFFF)
        if pages or usages.first > usages.last:
            self._warn("usages from a minimum to a maximum that is below it; left out")
            return
        self._declare(usages, low.extended or high.extended)

    def _declare(self, usages: Range, extended: bool) -> None:
        self._declared.append(_Declared(usages, extended, alternative=self._delimited and self._chosen))
        self._chosen = True
