"""Recordings of input devices, and devices that play them: JSON lines, identity and descriptor first, then reports.

    {"device": {"name": "Pad", "vendor": "046d", "product": "c216", "serial": "", "interface": 0, "usages": [[1, 4]]},
     "descriptor": "0501..."}                     (one line)
    {"time": 0.0, "report": "807f7f7f08000000"}
    {"time": 3.5, "unplugged": true}
    {"time": 5.0, "plugged": true}

Times are s from the beginning of the run. A recorded device is plugged in from before that, unless its first row plugs
it in. After its last row it goes on as it last was: it sends nothing more, and answers with its last report.
"""

from __future__ import annotations

import bisect
import json
import math
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from teleop.config.documents.document import DocumentError
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, HidDevice, shown
from teleop.inputs.hid.descriptor.parser import MAX_COLLECTIONS

UNPLUGGED, PLUGGED = "unplugged", "plugged"
AFTER = 1.0  # s from the last row to the end of the run
LONGEST = 86_400  # s: later rows have another clock's times, and a run up to them would never end
OPENING = 0.1  # s from the beginning of a run in which what is plugged in is opened
MAX_PROBLEMS = 20
LONGEST_VALUE = 60  # letters of a wrong value in a line about it


class Row(NamedTuple):
    """A report, or b"" where the device was plugged in or (`gone`) unplugged."""

    time: float
    report: bytes = b""
    gone: bool = False


@dataclass(frozen=True)
class Recording:
    """A device, once for each of its usages as the system lists it, and its rows in the order of their times."""

    infos: Sequence[DeviceInfo]
    descriptor: bytes
    rows: Sequence[Row]

    @property
    def end(self) -> float:
        """The time of the last row, s."""
        return self.rows[-1].time if self.rows else 0.0


def read_recording(file: Path, number: int = 1) -> Recording:
    """The recording in `file`, `number` of the run's. Raises DocumentError with a line for everything wrong."""
    try:
        lines = file.read_text(encoding="utf-8-sig").split("\n")
    except OSError as error:
        raise DocumentError([f"{file}: cannot be read: {error.strerror or error}"]) from None
    except UnicodeDecodeError:
        raise DocumentError([f"{file}: is not text; a recording is JSON lines"]) from None
    problems: list[str] = []
    records: list[tuple[int, Mapping[str, Any]]] = []
    for line, text in enumerate(lines, 1):
        if text.strip():
            try:
                record = json.loads(text)
                if not isinstance(record, dict):
                    raise ValueError("must be an object")
                records.append((line, record))
            except (ValueError, RecursionError) as error:
                problems.append(f"{file}:{line}: is not a JSON object: {error}")
    if not records and not problems:
        problems.append(f"{file}:1: the file is empty; its first line has the device and its descriptor")
    if problems:
        raise DocumentError(_first(problems, file))
    return _recording(file, number, records)


def _recording(file: Path, number: int, records: Sequence[tuple[int, Mapping[str, Any]]]) -> Recording:
    problems: list[str] = []
    infos: Sequence[DeviceInfo] = ()
    descriptor = b""
    line, head = records[0]
    try:
        infos = _infos(f"recording {number}: {file}".encode(), head.get("device"))
        descriptor = _hexadecimal(head, "descriptor")
    except ValueError as error:
        problems.append(f"{file}:{line}: {error}")
    rows: list[Row] = []
    for line, record in records[1:]:
        try:
            row = _row(record)
            if rows and row.time < rows[-1].time:
                raise ValueError(f"time must not be before that of the row above ({rows[-1].time:g} s)")
            rows.append(row)
        except ValueError as error:
            problems.append(f"{file}:{line}: {error}")
    if problems:
        raise DocumentError(_first(problems, file))
    return Recording(infos, descriptor, rows)


def _first(problems: Sequence[str], file: Path) -> list[str]:
    more = len(problems) - MAX_PROBLEMS
    return [*problems[:MAX_PROBLEMS], *([f"{file}: and {more} more"] if more > 0 else [])]


def _infos(path: bytes, device: Any) -> Sequence[DeviceInfo]:
    if not isinstance(device, dict):
        raise ValueError('the first line needs a "device", as `teleop devices record` writes it')
    ids = []
    for key in ("vendor", "product"):
        try:
            number = int(str(device.get(key)), 16)
        except ValueError:
            number = -1
        if not 0 <= number <= 0xFFFF:
            raise ValueError(f'device: "{key}" must be four hexadecimal digits, not {_brief(device.get(key))}')
        ids.append(number)
    usages = device.get("usages", [])
    if not isinstance(usages, list) or len(usages) > MAX_COLLECTIONS or not all(_is_usage(each) for each in usages):
        raise ValueError(f'device: "usages" must be a list of [page, usage], of {MAX_COLLECTIONS} at most')
    interface = device.get("interface", 0)
    if not isinstance(interface, int):
        raise ValueError(f'device: "interface" must be a number, not {_brief(interface)}')
    serial, name, port, driver = (shown(str(device.get(key) or "")) for key in ("serial", "name", "port", "driver"))
    return [
        DeviceInfo(path, ids[0], ids[1], serial, name, page, usage, interface, port, driver)
        for page, usage in usages or [(0, 0)]
    ]


def _brief(value: Any) -> str:
    """A wrong value in the line about it."""
    text = repr(value)
    return text if len(text) <= LONGEST_VALUE else f"{text[:LONGEST_VALUE]}..."


def _is_usage(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(isinstance(each, int) for each in value)


def _hexadecimal(record: Mapping[str, Any], key: str) -> bytes:
    try:
        return bytes.fromhex(record[key])
    except (KeyError, TypeError, ValueError):
        raise ValueError(f'"{key}" must be hexadecimal, not {_brief(record.get(key))}') from None


def _row(record: Mapping[str, Any]) -> Row:
    time = record.get("time")
    if isinstance(time, bool) or not isinstance(time, int | float) or not time >= 0:
        raise ValueError(f'"time" must be 0 s or later, not {_brief(time)}')
    if time > LONGEST:
        raise ValueError(f'"time" must be {LONGEST} s at most; it counts from the beginning of the run')
    if record.get(UNPLUGGED) is True:
        return Row(time, gone=True)
    if record.get(PLUGGED) is True:
        return Row(time)
    report = _hexadecimal(record, "report")
    if not report:
        raise ValueError('"report" must have a byte at least')
    return Row(time, report)


class RecordedDevices:
    """A backend of recordings, and of the devices of `others` if there are any.

    `begin` is when the run begins on the clock `now`, inf before it has.
    """

    def __init__(
        self,
        recordings: Sequence[Recording],
        now: Callable[[], float],
        begin: Callable[[], float],
        others: HidBackend | None = None,
    ) -> None:
        self._recordings, self._now, self._begin, self._others = recordings, now, begin, others

    def enumerate(self) -> Sequence[DeviceInfo]:
        time = self._time()
        there = [info for each in self._recordings if _is_plugged(each.rows, time) for info in each.infos]
        return [*there, *(self._others.enumerate() if self._others else ())]

    def open(self, path: bytes) -> HidDevice:
        for each in self._recordings:
            if each.infos[0].path == path:
                if not _is_plugged(each.rows, self._time()):
                    raise OSError("unplugged")
                time = self._time()
                return RecordedDevice(each, self._now, self._begin, time if time > OPENING else -math.inf)
        if self._others is None:
            raise OSError("no such device")
        return self._others.open(path)

    def _time(self) -> float:
        return self._now() - self._begin()


class RecordedDevice:
    """A recorded device, opened at `time` of the recording, -inf for before the run."""

    def __init__(self, recording: Recording, now: Callable[[], float], begin: Callable[[], float], time: float) -> None:
        self._recording, self._now, self._begin = recording, now, begin
        self._next = bisect.bisect_left(recording.rows, time, key=lambda row: row.time)
        self._reports: dict[int, bytes] = {}  # the last one of each first byte
        self._last = b""
        for row in recording.rows[: self._next]:
            self._answer_with(row)
        self._waiting = threading.Event()

    @property
    def next_report(self) -> float:
        """When it next reports, or is unplugged, on the run's clock; inf when it never will."""
        rows = self._recording.rows
        return self._begin() + rows[self._next].time if self._next < len(rows) else math.inf

    def get_report_descriptor(self) -> bytes:
        return self._recording.descriptor

    def read(self, timeout: float) -> bytes:
        end = self._now() + timeout
        if timeout and (wait := min(self.next_report, end) - self._now()) > 0:
            self._waiting.wait(wait)
        if timeout and self.next_report > self._now():
            return b""
        if self._next >= len(self._recording.rows):
            return b""
        row = self._recording.rows[self._next]
        if row.gone:
            raise OSError("unplugged")
        self._next += 1
        self._answer_with(row)
        return row.report

    def _answer_with(self, row: Row) -> None:
        """What the device reported is what it says when it is asked; one that was unplugged knows nothing any more."""
        if row.report:
            self._last = self._reports[row.report[0]] = row.report
        else:
            self._reports, self._last = {}, b""

    def get_input_report(self, report_id: int, length: int) -> bytes:
        answer = self._reports.get(report_id) if report_id else self._last
        if not answer:
            raise OSError("the recording has no answer")
        return answer[:length]

    def close(self) -> None:
        self._waiting.set()


def _is_plugged(rows: Sequence[Row], time: float) -> bool:
    past = rows[: bisect.bisect_right(rows, time, key=lambda row: row.time)]
    last = next((row for row in reversed(past) if not row.report), None)
    if last is None and rows and not rows[0].report and not rows[0].gone:
        return time >= rows[0].time
    return last is None or not last.gone
