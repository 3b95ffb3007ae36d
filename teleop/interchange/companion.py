"""The file beside a file that has no place for its units, axes, rotation order and frame rate: `shot.chan.json`.

It is JSON, so that people and programs read it; `teleop import` does when it is there.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeGuard

from teleop.config.documents.document import DocumentError
from teleop.config.documents.read_bytes import read_bytes
from teleop.config.frame_rates import exact
from teleop.core.axes import Axis
from teleop.interchange.motion import MOST_RATE, Motion
from teleop.interchange.rotation import HEAD, ORDERS
from teleop.interchange.table import Format, Hints

MOST_BYTES = 1_000_000
MARK = "teleop interchange"
RATE = re.compile(r"[0-9]{1,7}(\.[0-9]{0,20}|/[0-9]{1,7})?")


def beside(path: Path) -> Path:
    """Where it is."""
    return path.with_name(f"{path.name}.json")


def facts(motion: Motion, axes: Sequence[Axis], not_carried: Sequence[str]) -> dict[str, Any]:
    """What is true of the path in any format; the axes are in the order of their columns."""
    times = motion.times
    return {
        "made_by": f"{MARK}, version {version('rs-teleop')}",
        "title": motion.title,
        "origin": motion.origin,
        "kind": motion.kind,
        "frame_rate": str(motion.known_rate),  # exact: 24, 24000/1001
        "first_frame": motion.first,
        "rows": len(times),
        "row_times": "one for each frame" if motion.by_frame else "those of the recording",
        "start": float(times[0]) if len(times) else 0.0,
        "axes": [axis.value for axis in axes],
        "rotation_order": HEAD,
        "not_carried": list(not_carried),
    }


def text(motion: Motion, form: Format, axes: Sequence[Axis], not_carried: Sequence[str]) -> str:
    """The content of the file beside a file of this format."""
    content = {"format": form.name, **facts(motion, axes, not_carried), **(form.notes or {})}
    if form.name == "csv" and not motion.by_frame:
        content["frame_rate"] = content["first_frame"] = None  # its rows have times, and are no frames
    before = [*(["frame"] if motion.by_frame else []), "time"] if form.name == "csv" else []
    content.setdefault("columns", [*before, *(axis.value for axis in axes)])
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def read_beside(path: Path) -> dict[str, Any] | None:
    """What it says, None where there is none that teleop wrote. Raises DocumentError for one that cannot be read."""
    file = beside(path)
    if not file.is_file():
        return None
    return parsed(read_bytes(file, str(file), MOST_BYTES), str(file))


def parsed(raw: bytes, name: str) -> dict[str, Any] | None:
    """As `read_beside`, of its bytes."""
    try:
        content = json.loads(raw.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        line = f":{error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        raise DocumentError([f"{name}{line}: is not JSON; delete it and give what it said as options"]) from None
    return content if is_own(content) else None


def is_own(content: object) -> TypeGuard[dict[str, Any]]:
    """Whether it is what teleop has put into a file, or beside it."""
    return isinstance(content, dict) and MARK in str(content.get("made_by"))


def title_of(content: Mapping[str, Any]) -> str:
    """The title there."""
    return str(content.get("title", ""))[:200]


def hints_of(content: dict[str, Any], name: str, given: Hints, form: Format) -> Hints:
    """With what the file beside says, where the user has not said it. Raises DocumentError for nonsense."""
    rate = given.rate
    if rate is None and content.get("frame_rate") is not None:
        rate = file_rate(content["frame_rate"], name)
    order = content.get("rotation_order", HEAD)
    if order not in ORDERS:
        raise DocumentError([f"{name}: rotation_order must be one of {', '.join(ORDERS)}"])
    axes = content.get("axes", [])
    if not isinstance(axes, list) or not all(isinstance(each, str) and each in [*Axis] for each in axes):
        raise DocumentError([f"{name}: axes must be a list of {', '.join(axis.value for axis in Axis)}"])
    known = [Axis(each) for each in dict.fromkeys(axes)] or None
    columns = given.columns
    if form.name == "raw" and columns is None and known is not None:  # the others have names of their own
        columns = [axis.value for axis in known]
    order = given.rotation_order or order
    return replace(given, rate=rate, rotation_order=order, columns=columns, axes=given.axes or known)


def file_rate(value: object, name: str) -> Fraction:
    """A rate that a file of teleop has. Raises DocumentError."""
    text = str(value)
    try:  # a pattern, because Fraction would raise 10 to any exponent that a file has
        rate = Fraction(text) if RATE.fullmatch(text) else Fraction(0)
    except ZeroDivisionError:
        rate = Fraction(0)
    if not 0 < rate <= MOST_RATE:
        raise DocumentError([f"{name}: frame_rate must be frames a second, up to 1000"])
    return rate


def meant_rate(fps: float) -> Fraction | None:
    """The rate that another program's number means; None where it is none, as 0 and next to 0 are."""
    return (exact(fps).limit_denominator(1001) or None) if 0 < fps <= MOST_RATE else None
