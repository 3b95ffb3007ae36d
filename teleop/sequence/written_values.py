"""Texts, numbers and keyframes as they stand in the sequence files that this program writes."""

from __future__ import annotations

import json
from collections.abc import Mapping

from teleop.core.axes import Axis


def quoted(text: str) -> str:
    """In double quotes; what YAML does not permit as it is (U+0085 and others) is escaped."""
    letters = json.dumps(text, ensure_ascii=False)
    return "".join(letter if letter.isprintable() else f"\\U{ord(letter):08x}" for letter in letters)


def decimal(value: float, digits: int) -> str:
    """With so many digits (1 or more) behind the point at most, no exponent, and no minus before nothing."""
    return f"{round(value, digits) + 0.0:.{digits}f}".rstrip("0").rstrip(".")


def keyframe(at: str, positions: Mapping[Axis, str], hold: str, stop: bool) -> str:
    """A line of `keyframes`. `hold` is how long it rests there, "" where it does not; `stop` that it stops there."""
    values = [f"at: {at}", *(f"{axis.value}: {positions[axis]}" for axis in Axis if axis in positions)]
    if hold:
        values.append(f"hold: {hold}")
    elif stop:
        values.append("pass: stop")
    return f"  - {{{', '.join(values)}}}"
