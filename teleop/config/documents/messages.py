"""Rewrites pydantic's errors in the words of the file."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

Phrase = Callable[[Mapping[str, Any], Any], str]  # pydantic's context and the value given -> what is wrong


def nearest(word: str, known: Sequence[str]) -> str:
    """`; did you mean X?`, or nothing when no known word is like it."""
    near = difflib.get_close_matches(word, known, n=1)
    return f"; did you mean {near[0]}?" if near else ""


def shown(value: Any) -> str:
    """What stands in a file, shortened, as it may be written there."""
    if value is None:
        return "empty"
    text = repr(value) if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."


ALIASES: Mapping[str, str] = {
    "yaw": "pan",
    "pitch": "tilt",
    "time": "at",
    "name": "title",
    "speed": "velocity",
}
"""Words from elsewhere that people write for a key of ours; only where the level has that key."""
_ANGLES = "yaw is called pan here; pitch is tilt"
_DECIMAL_COMMA = re.compile(r"([-+]?[0-9]+),([0-9]+(?:s|m|h|%)?)")
_NO_SPACE = re.compile(r"(\w+):([^\s:].*)")


def unknown_key(key: str, known: Sequence[str], renamed: Mapping[str, str]) -> str:
    """What is wrong with a key that its mapping does not have; `known` are the keys of that mapping."""
    if key in renamed:
        return f"`{key}` is called `{renamed[key]}` now"
    likely = likely_key(key, known)
    if key in ("yaw", "pitch") and likely == ALIASES[key]:
        return f"unknown key `{key}`: {_ANGLES}"
    return f"unknown key `{key}`" + (f"; did you mean `{likely}`?" if likely else "")


def likely_key(key: str, known: Sequence[str]) -> str:
    """The key that was probably meant, "" for none: an alias first, then the nearest spelling."""
    if (alias := ALIASES.get(key)) in known:
        return str(alias)
    near = difflib.get_close_matches(key, known, n=1)
    return near[0] if near else ""


def missing_space(text: Any) -> str:
    """What is wrong with `pan:0`, which YAML reads as one word; "" for any other text."""
    match = _NO_SPACE.fullmatch(text) if isinstance(text, str) else None
    return f"a space is missing after `{match[1]}:`" if match else ""


def decimal_comma(text: Any) -> str:
    """What is wrong with `20,5`; "" for any other text."""
    match = _DECIMAL_COMMA.fullmatch(text.strip()) if isinstance(text, str) and len(text) <= 40 else None
    return f"{match[0]}: write {match[1]}.{match[2]}" if match else ""


def _number(_: Mapping[str, Any], given: Any) -> str:
    comma = decimal_comma(given)
    return f": {comma}" if comma else f"must be a number, not {shown(given)}"


def _list(_: Mapping[str, Any], given: Any) -> str:
    if given is None or isinstance(given, Mapping):
        return "must be a list: start each line with `- `"
    return f"must be a list, not {shown(given)}"


def _kind(what: str) -> Phrase:
    def phrase(_: Mapping[str, Any], given: Any) -> str:
        return f"must be {what}, not {shown(given)}"

    return phrase


def _bound(words: str, key: str) -> Phrase:
    def phrase(context: Mapping[str, Any], _: Any) -> str:
        bound = context[key]
        if words == "more than" and bound == 0:
            return "must be positive"
        return f"must be {words} {bound:g}"

    return phrase


def _one_of(context: Mapping[str, Any], given: Any) -> str:
    expected = str(context.get("expected") or context.get("expected_tags") or "")
    words = expected.replace("'", "").replace(" or ", ", ").split(", ")
    return f"must be one of {', '.join(words)}, not {shown(given)}{nearest(str(given), words)}"


PHRASES: Mapping[str, Phrase] = {
    "missing": lambda _context, _given: "is missing",
    "greater_than": _bound("more than", "gt"),
    "greater_than_equal": _bound("at least", "ge"),
    "less_than": _bound("less than", "lt"),
    "less_than_equal": _bound("at most", "le"),
    "float_type": _number,
    "int_type": _kind("a whole number"),
    "int_from_float": _kind("a whole number"),
    "finite_number": _kind("a finite number"),
    "string_type": _kind("text"),
    "bool_type": _kind("true or false"),
    "dict_type": _kind("a mapping"),
    "model_type": _kind("a mapping"),
    "model_attributes_type": _kind("a mapping"),
    "list_type": _list,
    "too_short": lambda context, _given: f"must have at least {context['min_length']}",
    "string_too_long": lambda context, _given: f"must be at most {context['max_length']} characters",
    "string_too_short": lambda _context, _given: "must not be empty",
    "literal_error": _one_of,
    "enum": _one_of,
    "union_tag_invalid": lambda context, _given: (
        f"type must be one of {str(context['expected_tags']).replace(chr(39), '')}, not {shown(context['tag'])}"
    ),
    "union_tag_not_found": lambda _context, _given: "needs a type",
    "value_error": lambda context, _given: str(context["error"]),
}
