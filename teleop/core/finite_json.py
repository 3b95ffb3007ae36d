"""JSON of finite numbers only: Python's own reads NaN, Infinity and 1e999 as numbers, which no command can have."""

from __future__ import annotations

import json
import math
from typing import Any


def loads(text: str | bytes) -> Any:
    """What `text` says. Raises ValueError for what is no JSON, RecursionError for what is too deep to be read."""
    return json.loads(text, parse_constant=_no_number, parse_float=_finite)


def _no_number(text: str) -> float:
    raise ValueError(f"{text} is no number")


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is too large")
    return number
