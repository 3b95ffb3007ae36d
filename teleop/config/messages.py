"""What pydantic calls an error, in the words of whoever wrote the file."""

from __future__ import annotations

import difflib
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
    "float_type": _kind("a number"),
    "int_type": _kind("a whole number"),
    "int_from_float": _kind("a whole number"),
    "finite_number": _kind("a finite number"),
    "string_type": _kind("text"),
    "bool_type": _kind("true or false"),
    "dict_type": _kind("a mapping"),
    "model_type": _kind("a mapping"),
    "model_attributes_type": _kind("a mapping"),
    "list_type": _kind("a list"),
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
