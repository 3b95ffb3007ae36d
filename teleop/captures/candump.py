"""candump's log format (`candump -L`): one line for each CAN frame, which can-utils and python-can read.

    (1732888888.123456) can0 222#AA1A002000000000

Read are also the lines of `candump -ta` and `-tA` as they stand on a terminal, with and without `-x`. can-utils refuses
the names of interfaces that Linux would refuse, so others are made to fit.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from datetime import datetime

from teleop.captures.captured import Captured, CaptureError

_NAME = 15  # characters of an interface's name: IFNAMSIZ of Linux less its zero
_LONGEST = 8  # bytes in a frame of classic CAN
_ERROR = 0x2000_0000  # bit of the id of an error frame: CAN_ERR_FLAG
_STANDARD = 3  # hexadecimal digits of a standard id
_SHOWN = 20  # characters of a line in a message

_TIME = r"\s*\((?P<time>[0-9][0-9 :.-]*)\)\s+(?P<name>\S+)\s+"
_LOG = re.compile(
    _TIME + r"(?P<id>[0-9A-Fa-f]{3}|[0-9A-Fa-f]{8})#(?P<fd>#[0-9A-Fa-f])?"
    r"(?:(?P<remote>[Rr])[0-9A-Fa-f_]*|(?P<data>(?:[0-9A-Fa-f]{2}\.?)*)(?:_[0-9A-Fa-f])?)(?:\s+[RTrt])?"
)
_TERMINAL = re.compile(
    _TIME + r"(?:[TR]X [B-] [E-]\s+)?(?P<id>[0-9A-Fa-f]{3}|[0-9A-Fa-f]{8})\s+\[\s*\d+\]"
    r"(?:\s+(?P<remote>remote request)|(?P<data>(?:\s+[0-9A-Fa-f]{2})*))(?:\s+(?:'.*'|ERRORFRAME.*))?"
)


def interface_name(channel: str) -> str:
    """A name for an interface that can-utils takes: of /dev/ttyACM0 ttyACM0, of 0 can0."""
    name = re.sub(r"[^A-Za-z0-9_.-]", "_", channel.rpartition("/")[2])[:_NAME] or "can"
    return f"can{name}"[:_NAME] if name.isdecimal() else name


def line(frame: Captured, interface: str) -> str:
    """The line of a frame, with its line feed."""
    can_id = f"{frame.id | _ERROR:08X}" if frame.error else f"{frame.id:08X}" if frame.extended else f"{frame.id:03X}"
    data = "R" if frame.remote else ("#0" if len(frame.data) > _LONGEST else "") + frame.data.hex().upper()
    return f"({frame.time:.6f}) {interface} {can_id}#{data}\n"


def frames(lines: Iterable[str], name: str) -> Iterator[tuple[str, Captured]]:
    """The interface and the frame of each line of the file called `name`. Raises CaptureError for what is none.

    A last line without an end was cut off when its writer was killed: it is left out when it is none.
    """
    for number, text in enumerate(lines, start=1):
        if not text.strip():
            continue
        match = _LOG.fullmatch(text.strip()) or _TERMINAL.fullmatch(text.strip())
        time = match and _seconds(match["time"])
        if match is None or time is None:
            if not text.endswith("\n") and number > 1:
                return
            raise CaptureError(
                f"{name}:{number}: no line of candump: {text.strip()[:_SHOWN]!r}; write the file with candump -L"
            )
        yield match["name"], _frame(match, time)


def _frame(match: re.Match[str], time: float) -> Captured:
    can_id = int(match["id"], 16)
    data = bytes.fromhex((match["data"] or "").replace(".", ""))
    is_error, is_extended = bool(can_id & _ERROR), len(match["id"]) > _STANDARD
    return Captured(
        time, can_id & (_ERROR - 1), data, is_extended and not is_error, match["remote"] is not None, is_error
    )


def _seconds(text: str) -> float | None:
    """Of `1732888888.123456` or `2024-11-29 14:01:28.123456`."""
    try:
        return float(text) if "-" not in text else datetime.fromisoformat(text.strip()).timestamp()
    except ValueError:
        return None
