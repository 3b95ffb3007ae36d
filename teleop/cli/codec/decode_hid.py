"""`teleop decode hid`: what a device's reports hold, for people whose device misbehaves; a JSON line for each report.

Standard output is records only, one for each report given. What is odd about the descriptor or about a report is said
on standard error, each thing once, since a device that sends short reports does so a thousand times a second.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from string import hexdigits
from typing import Annotated, Any

from cyclopts import Parameter

from teleop.cli.codec.decode import HEX_NOISE, InputError, not_understood, standard_input
from teleop.inputs.hid.descriptor.parser import Descriptor, parse_descriptor
from teleop.inputs.hid.descriptor.report import Control, read_report

Tell = Callable[[str], None]

_TEXT = re.compile(rb"[\t\n\r\x20-\x7e]*")
_COMMENTS = re.compile(r"//[^\n]*|#[^\n]*|/\*.*?\*/", re.DOTALL)
_BRACKETS = re.compile(r"[{}\[\]]")


def hid(
    *reports: Annotated[str, Parameter(help="Hexadecimal, one report each; without any, lines of standard input.")],
    descriptor: Annotated[
        Path,
        Parameter(
            metavar="FILE",
            help="File with the report descriptor, as bytes (Linux has it in "
            "/sys/class/hidraw/hidraw0/device/report_descriptor) or as hexadecimal.",
        ),
    ],
) -> None:
    """Decode input reports of a joystick, a gamepad or a dial.

    Where the descriptor has report ids, the first byte of a report is its id.
    """
    try:
        content = descriptor.read_bytes()
    except OSError as error:
        raise InputError(f"{descriptor}: {error.strerror}") from None
    tell = _once(f"teleop: {descriptor}")
    data, warning = descriptor_bytes(content)
    if warning:
        tell(warning)
    parsed = parse_descriptor(data)
    for warning in parsed.warnings:
        tell(warning)
    for line in decode_reports(parsed, reports or filter(str.strip, standard_input()), tell):
        print(line, flush=True)


def descriptor_bytes(content: bytes) -> tuple[bytes, str]:
    """The descriptor that a file holds, as bytes or as hexadecimal text, and what is odd about it ("" for nothing).

    Text is hexadecimal as people paste it: with 0x, commas, brackets and comments, in any lines.
    """
    text = content.removeprefix(b"\xef\xbb\xbf")
    if not _TEXT.fullmatch(text):
        return content, ""
    digits = HEX_NOISE.sub("", _BRACKETS.sub("", _COMMENTS.sub("", text.decode("ascii"))))
    if set(digits) - set(hexdigits):
        return content, "text, but not hexadecimal: taken as the bytes of a descriptor"
    if len(digits) % 2:
        return bytes.fromhex(digits[:-1]), "the hexadecimal ends inside a byte"
    return bytes.fromhex(digits), ""


def decode_reports(descriptor: Descriptor, lines: Iterable[str], tell: Tell) -> Iterator[str]:
    """A JSON line for each of `lines`, a report in hexadecimal; `tell` hears what is odd about them."""
    for line in lines:
        try:
            report = bytes.fromhex(HEX_NOISE.sub("", line))
        except ValueError:
            yield not_understood("not hexadecimal", line)
            continue
        if not report:
            yield not_understood("an empty report", line)
            continue
        number = report[0] if descriptor.numbered else 0
        for oddity in _oddities(descriptor, number, report):
            tell(oddity)
        yield json.dumps({"report_id": number, "controls": [_record(each) for each in read_report(descriptor, report)]})


def _oddities(descriptor: Descriptor, number: int, report: bytes) -> Iterator[str]:
    length = descriptor.lengths.get(number)
    if length is None:
        known = ", ".join(map(str, sorted(descriptor.lengths))) or "none"
        yield f"report {number} is not in the descriptor, which has inputs in: {known}"
    elif len(report) < length:
        yield f"report {number} has {len(report)} bytes of {length}: controls beyond are left out"
    elif len(report) > length:
        yield f"report {number} has {len(report)} bytes, {length} by the descriptor: the rest is not read"


def _record(control: Control) -> dict[str, Any]:
    record = {
        "usage_page": control.usage_page,
        "usage": control.usage,
        "name": control.name,
        "value": control.value,
        "min": control.minimum,
        "max": control.maximum,
        "relative": control.relative,
        "null": control.null,
    }
    return record if control.raw is None else {**record, "raw": control.raw}


def _once(prefix: str) -> Tell:
    """Says each thing on standard error the first time."""
    printed: set[str] = set()

    def tell(text: str) -> None:
        if text not in printed:
            printed.add(text)
            print(f"{prefix}: {text}", file=sys.stderr, flush=True)

    return tell
