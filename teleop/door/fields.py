"""What a field of a command may be: each check returns the value as it is used, or raises ValueError with why not."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from teleop.core.axes import Axis

Check = Callable[[Any], Any]

MOST_FIELDS = 16  # of a message of the protocol
AXES = {axis.value: axis for axis in Axis}


def number(low: float, high: float) -> Check:
    def check(value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise ValueError("must be a number")
        if not low <= value <= high:
            raise ValueError(f"must be {low:g} to {high:g}, not {value:g}")
        return float(value)

    return check


def whole(low: int, high: int) -> Check:
    def check(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError("must be a whole number")
        if not low <= value <= high:
            raise ValueError(f"must be {low} to {high}, not {value}")
        return value

    return check


def truth(value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError("must be true or false")
    return value


def text(longest: int, pattern: str = "") -> Check:
    """Printable text, which matches `pattern` as a whole where there is one."""
    matches = re.compile(pattern).fullmatch if pattern else None

    def check(value: Any) -> str:
        if not isinstance(value, str) or not value or not value.isprintable():
            raise ValueError("must be printable text")
        if len(value) > longest:
            raise ValueError(f"must have at most {longest} characters")
        if matches and not matches(value):
            raise ValueError("has characters that it may not have")
        return value

    return check


def axis(value: Any) -> Axis:
    found = AXES.get(value) if isinstance(value, str) else None
    if found is None:
        raise ValueError(f"must be an axis, such as {Axis.PAN}")
    return found


def axes(low: float, high: float) -> Check:
    """A number for each of some axes, at least one."""
    check_number = number(low, high)

    def check(value: Any) -> dict[Axis, float]:
        if not isinstance(value, Mapping) or not 0 < len(value) <= len(AXES):
            raise ValueError("must have a number for each axis that it names")
        return {axis(key): check_number(each) for key, each in value.items()}

    return check


_NAME, _WORD, _AMOUNT = text(40, r"[a-z][a-z0-9_]*"), text(64, r"[\w.+-]+"), number(-1e12, 1e12)


def plain_fields(value: Any) -> dict[str, str | int | float | bool]:
    """The fields of a message of the protocol: words and numbers."""
    if not isinstance(value, Mapping) or len(value) > MOST_FIELDS:
        raise ValueError(f"must be at most {MOST_FIELDS} fields with their values")
    for key, each in value.items():
        _NAME(key)
        if not isinstance(each, bool):
            (_WORD if isinstance(each, str) else _AMOUNT)(each)
    return dict(value)
