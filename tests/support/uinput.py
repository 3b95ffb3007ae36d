"""A wired Xbox pad that the kernel's uinput makes: an event device without hidraw, as xpad has it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import pytest
from fake_evdev import ABS, KEY, XBOX_BUTTONS, xbox_axes


class EventPad:
    """Plugged in; `show` gives it the values of its event codes by (type, code), each that is left out at rest."""

    def __init__(self, ids: tuple[int, int], values: Mapping[tuple[int, int], int]) -> None:
        from evdev import AbsInfo, UInput

        axes: Any = [
            (code, AbsInfo(values.get((ABS, code), axis.value), axis.min, axis.max, 0, 0, 0))
            for code, axis in xbox_axes().items()
        ]
        self._device: Any = UInput({KEY: list(XBOX_BUTTONS), ABS: axes}, "Microsoft X-Box One pad", *ids)
        self._values: Mapping[tuple[int, int], int] = {}
        self.show(values)

    def show(self, values: Mapping[tuple[int, int], int]) -> None:
        for kind, code in {**self._values, **values}:
            self._device.write(kind, code, values.get((kind, code), 0))
        self._device.syn()
        self._values = values

    def unplug(self) -> None:
        """Gone; unplugging again is fine."""
        if self._device is not None:
            self._device.close()
            self._device = None


@contextmanager
def event_pad(ids: tuple[int, int], values: Mapping[tuple[int, int], int]) -> Iterator[EventPad]:
    """A pad for the time of the block; skips the test where the kernel or its permissions do not have it."""
    from evdev import UInputError

    try:
        pad = EventPad(ids, values)
    except (OSError, UInputError) as error:
        pytest.skip(f"no event device can be made here: {error}; .ci/run boots a kernel where it can")
    try:
        yield pad
    finally:
        pad.unplug()
