"""What becomes of the axes that a command of a gimbal does not name: `send gimbal position yaw=10`.

Where the protocol has a bit that has the gimbal ignore an axis (V2.5 section 2.3.4.1), it is set. Speeds and
deflections have no such bit: an axis that is not named gets 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

AXES: Final = ("yaw", "roll", "pitch")


def unnamed(fields: Mapping[str, Any]) -> Sequence[str]:
    """The axes that a command leaves out, when it has at least one of them."""
    left_out = [axis for axis in AXES if axis not in fields]
    return left_out if len(left_out) < len(AXES) else ()


def ignoring(fields: Mapping[str, Any]) -> Mapping[str, Any]:
    """The fields of a command to angles: an axis that is left out is ignored."""
    filled = dict.fromkeys(unnamed(fields), 0.0)
    return {**filled, **{f"{axis}_ignored": True for axis in filled}, **fields}


def resting(fields: Mapping[str, Any]) -> Mapping[str, Any]:
    """The fields of a command of speeds or deflections: an axis that is left out gets 0."""
    return {**dict.fromkeys(unnamed(fields), 0), **fields}
