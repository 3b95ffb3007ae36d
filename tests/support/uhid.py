"""A HID device that the kernel's uhid makes of nothing; `hidraw` and everything above take it for one plugged in.

Events and their layouts are those of Linux's uapi/linux/uhid.h; a process that closes /dev/uhid unplugs its device.
"""

from __future__ import annotations

import os
import select
import struct
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import Any

import pytest

_DEVICE = "/dev/uhid"
_DESTROY, _GET_REPORT, _GET_REPORT_REPLY, _CREATE2, _INPUT2, _SET_REPORT, _SET_REPORT_REPLY = 1, 9, 10, 11, 12, 13, 14
_CREATE = struct.Struct("<I128s64s64sHHIIII4096s")  # type, three names, sizes and ids, the descriptor
_EVENT = 4380  # bytes of the largest event
_USB = 3
_PERIOD = 0.01  # s: a pad on USB is asked a hundred times a second


class Pad:
    """A device plugged in, repeating the report that `show` gave it until it is unplugged.

    `device` is one of shared vectors' devices (tests/data/hid.json): its name, ids and descriptor.
    """

    def __init__(self, device: Mapping[str, Any], report: bytes) -> None:
        descriptor = bytes.fromhex(device["descriptor"])
        self._report = report
        self._over = threading.Event()
        self._file = os.open(_DEVICE, os.O_RDWR | os.O_CLOEXEC)
        name, ids = device["name"].encode(), (device["vendor_id"], device["product_id"])
        self._write(_CREATE.pack(_CREATE2, name, b"usb-test", b"0001", len(descriptor), _USB, *ids, 0, 0, descriptor))
        self._thread = threading.Thread(target=self._serve, name="uhid", daemon=True)
        self._thread.start()

    def show(self, report: bytes) -> None:
        self._report = report

    def unplug(self) -> None:
        """Gone; unplugging again is fine."""
        if not self._over.is_set():
            self._over.set()
            self._thread.join()
            self._write(struct.pack("<I", _DESTROY))
            os.close(self._file)

    def _serve(self) -> None:
        while not self._over.wait(_PERIOD):
            while select.select([self._file], [], [], 0)[0]:
                self._answer(os.read(self._file, _EVENT))
            self._write(struct.pack("<IH", _INPUT2, len(self._report)) + self._report)

    def _answer(self, event: bytes) -> None:
        kind, number = struct.unpack_from("<II", event)
        if kind == _GET_REPORT:
            self._write(struct.pack("<IIHH", _GET_REPORT_REPLY, number, 0, len(self._report)) + self._report)
        elif kind == _SET_REPORT:
            self._write(struct.pack("<IIH", _SET_REPORT_REPLY, number, 0))

    def _write(self, event: bytes) -> None:
        os.write(self._file, event)


@contextmanager
def plugged_in(device: Mapping[str, Any], report: bytes) -> Iterator[Pad]:
    """A pad for the time of the block; skips the test where the kernel or its permissions do not have it."""
    try:
        pad = Pad(device, report)
    except OSError as error:
        pytest.skip(f"no HID device can be made here: {error}; .ci/run boots a kernel where it can")
    try:
        yield pad
    finally:
        with suppress(OSError):
            pad.unplug()
