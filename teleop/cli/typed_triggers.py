"""`--trigger time 18:30:00` as one word, as programs write it; apart from the options, which take long to load."""

from __future__ import annotations

import re
from collections.abc import Sequence

_TRIGGER = re.compile(r"--trigger[ =](time|timecode|osc)")
_WHAT = {"time": re.compile(r"\d+:"), "timecode": re.compile(r"\d+:"), "osc": re.compile(r"([^:/\s]+:)?\d+/")}


def joined(arguments: Sequence[str]) -> list[str]:
    """What was typed, with `--trigger time 18:30:00` made one word of, as it is for programs."""
    result: list[str] = []
    for argument in arguments:
        kind = _TRIGGER.fullmatch(" ".join(result[-2:])) or _TRIGGER.fullmatch(" ".join(result[-1:]))
        if kind and _WHAT[kind[1]].match(argument):
            result[-1] += f":{argument}"
        else:
            result.append(argument)
    return result
