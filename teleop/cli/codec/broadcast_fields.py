"""`teleop decode onboard --parts`: what the drone's broadcast can hold, from the classes that decode it.

A frame says neither units nor whether its data are raw or fused, so a reader of the JSON lines has to find them
somewhere.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

from teleop.dji.drone.broadcast import PARTS, A3Broadcast, Broadcast, Several, Single

WIDTH = 100  # columns


def parts() -> Iterator[str]:
    """Lines for people: each part with its flag in either layout, and its fields in the order of the wire."""
    for name in A3Broadcast.order:
        m100 = f"bit {Broadcast.order.index(name)}" if name in Broadcast.order else "none"
        yield f"{name}: m100 {m100}, a3 bit {A3Broadcast.order.index(name)}, {PARTS[name].size} bytes"
        yield from _fields(PARTS[name])
        yield ""


def _fields(part: Single | Several) -> Iterator[str]:
    if isinstance(part, Single):
        yield f"    {part.wire.requirement()}"
        return
    yield from _wrapped("  ", "  ", " ".join((part.cls.__doc__ or "").split()))
    for field in part.cls.layout.fields:
        if field.name != "reserved":
            yield from _wrapped(f"    {field.name:14} ", " " * 19, field.wire.requirement())


def _wrapped(first: str, later: str, text: str) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=first, subsequent_indent=later)
