"""An open event device that speaks as a HID device: the kernel's events in, one report for each of their frames out.

The device is never grabbed: other programs go on reading it. The kernel says only what changes, so that what was held
when it was opened is asked for first, and again where the kernel says that events were dropped.
"""

from __future__ import annotations

import errno
import os
import select
import struct
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from teleop.inputs.evdev.layout import ABS, KEY, REL, AxisInfo, Layout

_EVENT = struct.Struct("@llHHi")  # struct input_event: two longs of time, type, code, value
_AT_ONCE = 64  # events of one read
_SYN, _SYN_REPORT, _SYN_DROPPED = 0, 0, 3


class EventSource(Protocol):
    """What is used of evdev's InputDevice. Every call raises OSError once the device is unplugged."""

    @property
    def fd(self) -> int: ...
    def capabilities(self) -> Mapping[int, Sequence[Any]]: ...
    def absinfo(self, axis_num: int) -> AxisInfo: ...
    def active_keys(self) -> Sequence[int]: ...
    def close(self) -> None: ...


class EventDevice:
    """A HidDevice on `source`; raises OSError when it is gone already."""

    def __init__(self, source: EventSource, keeps_names: bool) -> None:
        self._source = source
        found = source.capabilities()
        axes: Mapping[int, AxisInfo] = dict(found.get(ABS, ()))
        self._axes = tuple(axes)
        self._layout = Layout(axes, found.get(KEY, ()), found.get(REL, ()), keeps_names=keeps_names)
        self._values: dict[tuple[int, int], int] = {}
        self._rest = b""  # the beginning of an event
        self._changed = self._dropped = False  # in the frame that has begun
        self._reports: deque[bytes] = deque()
        self._ask()

    def get_report_descriptor(self) -> bytes:
        return self._layout.descriptor

    def read(self, timeout: float) -> bytes:
        """The next report, first of all the device as it was when opened; b"" when none comes within `timeout` s."""
        if not self._reports and select.select([self._source.fd], [], [], timeout)[0]:
            self._take()
        return self._reports.popleft() if self._reports else b""

    def get_input_report(self, report_id: int, length: int) -> bytes:  # noqa: ARG002 - there is one report
        """The device as it is by its events; raises OSError when the kernel no longer has it."""
        self._source.active_keys()
        return self._layout.report(self._values)[:length]

    def close(self) -> None:
        self._source.close()

    def _take(self) -> None:
        try:
            data = os.read(self._source.fd, _AT_ONCE * _EVENT.size)
        except BlockingIOError:  # another reader of this descriptor, or none at all
            return
        if not data:
            raise OSError(errno.ENODEV, os.strerror(errno.ENODEV))
        data = self._rest + data
        whole = len(data) - len(data) % _EVENT.size
        self._rest = data[whole:]
        for _, _, kind, code, value in _EVENT.iter_unpack(data[:whole]):
            self._event(kind, code, value)

    def _event(self, kind: int, code: int, value: int) -> None:
        if (kind, code) == (_SYN, _SYN_DROPPED):
            self._dropped = True
        elif (kind, code) == (_SYN, _SYN_REPORT):
            self._end_frame()
        elif (kind, code) in self._layout.codes and not self._dropped:
            self._values[kind, code] = value + (self._values.get((kind, code), 0) if kind == REL else 0)
            self._changed = True

    def _end_frame(self) -> None:
        if self._dropped:
            self._ask()
        elif self._changed:
            self._reports.append(self._layout.report(self._values))
        for code in [code for code in self._values if code[0] == REL]:
            del self._values[code]
        self._changed = self._dropped = False

    def _ask(self) -> None:
        """Take over what the kernel knows: an axis between two events is as it was."""
        self._values = {(ABS, code): self._source.absinfo(code).value for code in self._axes}
        self._values.update({(KEY, code): 1 for code in self._source.active_keys()})
        self._reports.append(self._layout.report(self._values))
