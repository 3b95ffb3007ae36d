"""Texts and numbers of a YAML file that is written whole, as people write them."""

from __future__ import annotations

import json


def quoted(text: str) -> str:
    """In double quotes; what YAML does not permit as it is (U+0085 and others) is escaped."""
    whole = json.dumps(text, ensure_ascii=False)
    return "".join(letter if letter.isprintable() else f"\\U{ord(letter):08x}" for letter in whole)


def number(value: float, digits: int = 6) -> str:
    """With so many digits behind the point, at most 6, without an exponent, and without a minus before nothing."""
    return f"{round(value, digits) + 0.0:.6f}".rstrip("0").rstrip(".")
