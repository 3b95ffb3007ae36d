"""OSC 1.0 packets as bytes and as messages: what a stranger sends is either messages or an OscError, and soon known.

A bundle is its messages, at once, whatever its time tag. Addresses with wildcards are addresses like any other.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

LARGEST = 8192  # bytes of a packet
MOST_MESSAGES = 64  # in one
MOST_ARGUMENTS = 64  # of a message
DEEPEST = 4  # bundles in bundles
BUNDLE = b"#bundle\0"
HEAD = len(BUNDLE) + 8  # bytes of a bundle before its first element: the name and the time tag

Argument = int | float | str | bytes | bool | None


class OscError(ValueError):
    """Why bytes are no OSC packet."""


class Message(NamedTuple):
    """An address and its arguments, those of arrays among them."""

    address: str
    arguments: tuple[Argument, ...] = ()


def messages(data: bytes) -> list[Message]:
    """Every message of a packet, in its order. Raises OscError for bytes that are none, and for a packet too large."""
    if len(data) > LARGEST:
        raise OscError(f"a packet of {len(data)} bytes; {LARGEST} are the most")
    found: list[Message] = []
    for message in _elements(data, 0):
        found.append(message)
        if len(found) > MOST_MESSAGES:
            raise OscError(f"more than {MOST_MESSAGES} messages in a packet")
    return found


def packet(address: str, *arguments: float | str | bool) -> bytes:
    """One message: an int as `i`, a float as `f`, text as `s`, a bool as `T` or `F`."""
    tags, body = ",", b""
    for argument in arguments:
        tag, data = _packed(argument)
        tags, body = tags + tag, body + data
    return _text(address) + _text(tags) + body


def _packed(argument: float | str | bool) -> tuple[str, bytes]:
    if isinstance(argument, bool):
        return ("T" if argument else "F"), b""
    if isinstance(argument, str):
        return "s", _text(argument)
    return ("i", struct.pack(">i", argument)) if isinstance(argument, int) else ("f", struct.pack(">f", argument))


def _text(text: str) -> bytes:
    data = text.encode().replace(b"\0", b"")
    return data + b"\0" * (4 - len(data) % 4)


def _elements(data: bytes, depth: int) -> Iterator[Message]:
    if not data.startswith(BUNDLE):
        yield _message(data)
        return
    if depth >= DEEPEST:
        raise OscError(f"more than {DEEPEST} bundles in each other")
    if len(data) < HEAD:
        raise OscError("a bundle without its time tag")
    at = HEAD
    while at < len(data):
        size, at = _number(data, at, ">i", 4)
        if size <= 0 or size % 4 or at + size > len(data):
            raise OscError("an element of a bundle with a wrong size")
        yield from _elements(data[at : at + size], depth + 1)
        at += size


def _message(data: bytes) -> Message:
    if len(data) % 4 or not data.startswith(b"/"):
        raise OscError("no message: its address begins with /, and its length is a multiple of 4")
    address, at = _string(data, 0)
    if at == len(data):  # a sender of before OSC 1.0: there are no arguments
        return Message(address)
    tags, at = _string(data, at)
    if not tags.startswith(",") or len(tags) > MOST_ARGUMENTS + 1:
        raise OscError("a message without proper type tags")
    arguments: list[Argument] = []
    for tag in tags[1:]:
        if tag in "[]":
            continue
        if (read := READERS.get(tag)) is None:
            raise OscError(f"an argument of unknown type {tag!r}")
        value, at = read(data, at)
        arguments.append(value)
    if at != len(data):
        raise OscError("a message that is longer than its arguments")
    return Message(address, tuple(arguments))


def _string(data: bytes, at: int) -> tuple[str, int]:
    end = data.find(b"\0", at)
    if end < 0:
        raise OscError("a text without an end")
    try:
        return data[at:end].decode(), end + 4 - (end - at) % 4
    except UnicodeDecodeError:
        raise OscError("a text that is no UTF-8") from None


def _blob(data: bytes, at: int) -> tuple[bytes, int]:
    size, at = _number(data, at, ">i", 4)
    end = at + size + -size % 4
    if size < 0 or end > len(data):
        raise OscError("a blob with a wrong size")
    return data[at : at + size], end


def _number(data: bytes, at: int, layout: str, size: int) -> tuple[int, int]:
    if at + size > len(data):
        raise OscError("an argument that is not there")
    return struct.unpack_from(layout, data, at)[0], at + size


def _numbers(layout: str) -> Callable[[bytes, int], tuple[Argument, int]]:
    size = struct.calcsize(layout)
    return lambda data, at: _number(data, at, layout, size)


def _without_bytes(value: Argument) -> Callable[[bytes, int], tuple[Argument, int]]:
    return lambda _data, at: (value, at)


READERS: Mapping[str, Callable[[bytes, int], tuple[Argument, int]]] = {
    "i": _numbers(">i"),
    "f": _numbers(">f"),
    "s": _string,
    "S": _string,
    "b": _blob,
    "h": _numbers(">q"),
    "d": _numbers(">d"),
    "t": _numbers(">Q"),
    "c": _numbers(">I"),
    "r": _numbers(">I"),
    "m": _numbers(">I"),
    "T": _without_bytes(True),
    "F": _without_bytes(False),
    "N": _without_bytes(None),
    "I": _without_bytes(True),
}
