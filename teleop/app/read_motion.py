"""A file of another program as a path: which format it is, and what the file beside it and the user say of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.config.documents.read_bytes import read_bytes
from teleop.core.axes import Axis
from teleop.core.plain import plain
from teleop.interchange import companion
from teleop.interchange.kuper import is_kuper
from teleop.interchange.motion import Motion, shown
from teleop.interchange.raw_move import is_raw_move
from teleop.interchange.rotation import HEAD
from teleop.interchange.table import BY_NAME, Format, Hints

MOST_BYTES = 64_000_000


def sniffed(file: Path) -> Format | None:
    """The format of a text file, where its content or the file beside it leaves no doubt. Raises DocumentError."""
    content = companion.read_beside(file) or {}
    if content.get("format") in BY_NAME:
        return BY_NAME[content["format"]]
    raw = read_bytes(file, str(file), MOST_BYTES)
    return BY_NAME["kuper"] if is_kuper(raw) else BY_NAME["raw"] if is_raw_move(raw) else None


def read_motion(
    file: Path, form: Format, given: Hints, only: Sequence[Axis] | None = None, inverted: Sequence[Axis] = ()
) -> Motion:
    """The path in a file, of the axes `only`, with those `inverted` the other way round.

    Raises UsageError without a library of the format, DocumentError for what is wrong with the file.
    """
    reader = form.load()
    content = None if form.notes is None else companion.read_beside(file)
    name = str(file)
    hints = given if content is None else companion.hints_of(content, str(companion.beside(file)), given, form)
    motion: Motion = reader.read(read_bytes(file, name, MOST_BYTES), name, hints)
    if content is not None:
        motion = replace(motion, title=motion.title or companion.title_of(content))
    if hints.axes is not None:
        known = {axis: column for axis, column in motion.positions.items() if axis in hints.axes}
        motion = replace(motion, positions=known or motion.positions)
    elif form.name in ("chan", "usd") and not motion.title:  # a title: teleop wrote it, and the axes are its own
        motion = _without_idle(motion)
    motion = replace(motion, title=motion.title or file.stem)
    return _chosen(motion, name, only, inverted)


def _without_idle(motion: Motion) -> Motion:
    """Without a roll that is 0 in every frame: a camera always has one, and not every head."""
    roll = motion.positions.get(Axis.ROLL)
    if roll is None or bool(np.any(np.abs(roll) > 1e-9)):
        return motion
    positions = {axis: column for axis, column in motion.positions.items() if axis is not Axis.ROLL}
    return replace(motion, positions=positions, remarks=[*motion.remarks, "roll: it is 0 in every frame"])


def _chosen(motion: Motion, name: str, only: Sequence[Axis] | None, inverted: Sequence[Axis]) -> Motion:
    missing = [axis for axis in (*(only or ()), *inverted) if axis not in motion.positions]
    if missing and motion.positions:
        raise DocumentError([f"{name}: has no {missing[0]}; it has {', '.join(motion.axes)}"])
    positions = {axis: column for axis, column in motion.positions.items() if only is None or axis in only}
    positions = {axis: -column if axis in inverted else column for axis, column in positions.items()}
    return replace(motion, positions=positions)


def origin_lines(file: Path, form: Format, motion: Motion, hints: Hints, tolerance: float) -> Iterator[str]:
    """What the comments of a new sequence file say of where it comes from."""
    rate = "" if motion.rate is None else f", {shown(motion.rate)}"
    rate += f" ({motion.rate})" if motion.rate is not None and motion.rate.denominator > 1 else ""
    order = f", rotation order {hints.rotation_order or HEAD}" if form.order else ""
    yield f"Imported by teleop {version('rs-teleop')} from {plain(file.name)} ({form.title}{rate}{order})."
    if motion.positions:
        count, first = len(motion.times), motion.first
        yield f"{count} frames, from frame {first} on; the move is within {tolerance:g} degrees of them."
    for remark in motion.remarks:
        yield f"Left out: {remark}"
