"""A sequence file as people write it: one keyframe a line, times in seconds, no more digits than mean something."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.planner.keyframes.tension import EVEN, Tension
from teleop.recording.to_keyframes.merge_keys import MergedKey
from teleop.recording.to_keyframes.reference import GRID
from teleop.sequence.written_values import decimal, keyframe, quoted


@dataclass(frozen=True)
class SequenceText:
    """What is to stand in the file; cues are (s, action), `digits` those of positions behind the point."""

    title: str
    tension: Tension
    frames: Sequence[MergedKey]
    cues: Sequence[tuple[float, Action]]
    digits: Mapping[Axis, int]


def sequence_text(sequence: SequenceText) -> str:
    """The YAML of a sequence, as `load_sequence` reads it."""
    return "\n".join(_lines(sequence)) + "\n"


def _lines(sequence: SequenceText) -> Iterator[str]:
    yield f"title: {quoted(sequence.title)}"
    if sequence.tension != EVEN:
        yield f"tension: {sequence.tension:g}"
    yield "keyframes:"
    for frame in sequence.frames:
        yield _frame(frame, sequence.digits)
    if sequence.cues:
        yield "cues:"
    for time, action in sequence.cues:
        yield f"  - {{at: {time:.2f}, camera: {action.value}}}"


def _frame(frame: MergedKey, digits: Mapping[Axis, int]) -> str:
    positions = {axis: decimal(round(at, digits[axis]), 6) for axis, at in frame.positions.items()}
    hold = f"{_seconds(frame.hold)}s" if frame.hold else ""
    return keyframe(_seconds(frame.place), positions, hold, frame.stop)


def _seconds(places: int) -> str:
    return decimal(places / GRID, 6)
