"""Lawicel's ASCII protocol, as slcan adapters speak it over a serial port: `t2238` and sixteen hex digits, then CR.

python-can has it too, but there a write without a timeout blocks for ever on an adapter that stops reading, a write
with one is reported as failed on a loaded host though it has left (sending it again doubles a CAN frame), one byte that
is no UTF-8 fails every later read, and each byte costs two system calls. Here a line that fits only in part is finished
before the next, and what arrives is cut into lines at once.

CR alone, z CR and Z CR acknowledge, each with or without a line feed behind it; BEL refuses: the adapter's queue is
full or its bus is off. A frame that was refused is damage to one DJI frame; an adapter that only refuses for 250 ms has
a bus that is full or off. The answer to a frame comes after it, so from then on each frame is still offered before it
is reported as not sent.
"""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace

from teleop.links.can import Arrival, BusFrame, Tap
from teleop.links.faults import opening_failed
from teleop.links.outbox import Stall
from teleop.links.serial import Port, SerialPort
from teleop.links.slcan_opening import ACKNOWLEDGEMENTS, go_on_bus
from teleop.links.url import LinkAddress

_BAUD = 115_200  # bit/s of the serial line unless the channel says otherwise (PORT@BAUD); USB adapters ignore it
_BITRATES = (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000)  # bit/s, by S0 .. S8
_LONGEST_LINE = 64  # bytes; a frame has at most 30: what is longer has lost its end
_LINE = re.compile(rb"([^\r\n\a]*)([\r\n\a])")
_BELL = b"\a"
_FRAME = re.compile(rb"(?:([tr])([0-9A-Fa-f]{3})|([TR])([0-9A-Fa-f]{8}))([0-8])([0-9A-Fa-f]*)")
_TIME_STAMP = 4  # hex digits behind the data, where an adapter is set to give them


class SlcanAdapter:
    """A teleop.links.can.Adapter behind an open port. Counts `damage` (a line that is no CAN frame) and `refused`."""

    failures = (OSError,)

    def __init__(self, address: LinkAddress, port: Port, counts: Counter[str], now: Callable[[], float]) -> None:
        self._address = address
        self._port = port
        self._counts = counts
        self._refusing = Stall(now)
        self._acknowledges = False  # some adapters never do, and one answer of theirs proves nothing
        self._text = b""  # arrived, and not yet a line
        self._arrived: list[Arrival] = []
        self.tap: Tap | None = None
        self._unsent = b""

    def command(self, text: bytes) -> None:
        """Send a command of the adapter itself, after what is still to leave."""
        self._unsent += text
        self._finish_line()

    def replies(self) -> Iterator[tuple[bytes, bool]]:
        """The lines that have arrived while the adapter is being opened, and whether each refuses."""
        self._finish_line()
        for line, terminator in self._lines():
            yield line, terminator == _BELL

    def hear(self, line: bytes) -> bool:
        """Keep a line that arrived while the adapter was being opened; whether it is a frame."""
        arrival = _parse(line)
        if arrival:
            self._arrived.append(arrival)
        self._acknowledges |= line in ACKNOWLEDGEMENTS
        return arrival is not None

    def put(self, can_id: int, data: bytes) -> bool:
        if self._refusing.proved:
            self._read()
        if not self._finish_line():
            return False
        self._unsent = b"t%03X%d%s\r" % (can_id, len(data), data.hex().upper().encode())
        self._finish_line()
        if self._refusing.proved:
            self._check()
        return True

    def take(self) -> list[Arrival]:
        self._finish_line()
        if self._read():
            self._check()
        arrived, self._arrived = self._arrived, []
        return arrived

    def close(self) -> None:
        self._unsent += b"C\r"
        try:
            self._finish_line()
        finally:
            self._port.close()

    def _finish_line(self) -> bool:
        if self._unsent:
            self._unsent = self._unsent[self._port.write(self._unsent) :]
        return not self._unsent

    def _read(self) -> bool:
        """Takes in what has arrived; whether the adapter refused a frame in it."""
        refused = self._counts["refused"]
        for line, terminator in self._lines():
            self._understand(line, terminator)
        if len(self._text) > _LONGEST_LINE:
            self._counts["damage"] += 1
            self._text = b""
        return self._counts["refused"] > refused

    def _lines(self) -> list[tuple[bytes, bytes]]:
        """The whole lines that have arrived, and how each ends; the line feed of a CR LF is none."""
        text = self._text + self._port.read()
        found = list(_LINE.finditer(text))
        self._text = text[found[-1].end() :] if found else text
        return [(match[1], match[2]) for match in found if match[1] or match[2] != b"\n"]

    def _understand(self, line: bytes, terminator: bytes) -> None:
        if terminator == _BELL:
            if self._acknowledges:
                self._counts["refused"] += 1
                self._refusing.begin()
        elif line in ACKNOWLEDGEMENTS:
            self._acknowledges = True
            self._refusing.end()
        elif arrival := _parse(line):
            self._arrived.append(arrival)
            if self.tap:
                self.tap(BusFrame(arrival.id, arrival.data, line[:1] in b"TR", line[:1] in b"rR"))
        else:
            self._counts["damage"] += 1

    def _check(self) -> None:
        self._refusing.check(f"{self._address}: the adapter refuses every frame: is the bus connected and terminated?")


def open_slcan(address: LinkAddress, counts: Counter[str], now: Callable[[], float]) -> SlcanAdapter:
    """The adapter at `address`, on its bus, once it has answered: within 3 s. Raises LinkError."""
    path, _, baud = address.channel.partition("@")
    named = replace(address, channel=path)
    try:
        if address.bitrate not in _BITRATES:
            raise ValueError(f"slcan has the bit rates {', '.join(map(str, _BITRATES))}, not {address.bitrate}")
        if baud and not baud.isdecimal():
            raise ValueError(f"the serial line's rate is a whole number of bit/s, not {baud!r}")
        port = SerialPort(path, int(baud or _BAUD))
        try:
            adapter = SlcanAdapter(named, port, counts, now)
            go_on_bus(adapter, named, _BITRATES.index(address.bitrate), time.sleep)
        except BaseException:  # Ctrl-C too
            port.close()
            raise
    except (OSError, ValueError) as error:
        raise opening_failed(named, error) from error
    return adapter


def _parse(line: bytes) -> Arrival | None:
    """The CAN frame that a line stands for, None for damage."""
    match = _FRAME.fullmatch(line)
    if match is None:
        return None
    kind, digits = match[1] or match[3], match[2] or match[4]
    remote = kind in b"rR"
    length = 0 if remote else 2 * int(match[5])
    if len(match[6]) not in (length, length + _TIME_STAMP):
        return None
    return Arrival(int(digits, 16), kind == b"t", bytes.fromhex(match[6][:length].decode()))
