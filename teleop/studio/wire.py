"""What rigs and operators say to each other: the keys, and JSON within bounds.

`teleop/<rig>/state` and `event` are pushed by the rig, `stick` by an operator. `command` is asked and answered;
`command/stop` and `command/clock` are commands that a watcher may give too, and so have keys of their own, because
access lists know keys. A token at `alive` says that the rig is there, one at `alive/<session>` that an operator is.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from teleop.core.finite_json import loads

ROOT = "teleop"
STATES, EVENTS, ALIVES = f"{ROOT}/*/state", f"{ROOT}/*/event", f"{ROOT}/*/alive"
LARGEST = 4096  # bytes of a message to a rig that is no move
LARGEST_MOVE = 1_000_000  # bytes of a move's text
LARGEST_LOAD = 2_100_000  # of the message with it: JSON needs more for each line end and quote
LARGEST_STATE = 64_000  # bytes of a state
DEEPEST = 12  # levels of a message
SESSION = re.compile(r"[\w-]{1,32}", re.ASCII)


def key(rig: str, what: str) -> str:
    """Where a rig has its `what`: state, event, stick, command, command/stop, command/clock, alive."""
    return f"{ROOT}/{rig}/{what}"


def rig_of(text: str) -> str:
    """The rig that a key is about."""
    return text.split("/", 2)[1]


def encoded(message: Mapping[str, Any]) -> bytes:
    """As JSON. Raises ValueError for what it cannot hold."""
    return json.dumps(message, separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode()


def decoded(data: bytes, most: int = LARGEST) -> dict[str, Any]:
    """The map that a message is. Raises ValueError for anything else, whatever the bytes."""
    if len(data) > most:
        raise ValueError(f"has {len(data)} bytes, and may have {most}")
    try:
        found = loads(data)
    except (ValueError, RecursionError):  # UnicodeDecodeError is one
        raise ValueError("is no JSON") from None
    if not isinstance(found, dict) or _depth(found) > DEEPEST:
        raise ValueError(f"must be a map of at most {DEEPEST} levels")
    return found


def _depth(value: Any) -> int:
    """How many levels it has, counted without recursion up to one more than is allowed."""
    level, depth = [value], 0
    while level and depth <= DEEPEST:
        depth += 1
        level = [
            each
            for outer in level
            if isinstance(outer, dict | list)
            for each in (outer.values() if isinstance(outer, dict) else outer)
        ]
    return depth
