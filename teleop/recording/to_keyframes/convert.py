"""A take as a sequence that can be edited: sparse keyframes whose own plan stays within a tolerance of the recording.

The result is checked by the program itself: the finished file is read, planned and compared with the recording at every
hundredth of a second, and that error is what the user sees. A recording of a hand at a stick
is nearer to constant speeds, one of a planned move to least jerk: both are tried, and the sparser one is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, log10
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.planner.keyframes.fit import SampledSegment, Style, fit, fit_through
from teleop.planner.keyframes.program import HEADROOM
from teleop.planner.keyframes.tension import EVEN, Tension
from teleop.planner.polynomial import Array
from teleop.recording.reader import Take
from teleop.recording.replay import cues
from teleop.recording.to_keyframes.knots import planned_keys
from teleop.recording.to_keyframes.merge_keys import AxisKey, MergedKey, merge_keys
from teleop.recording.to_keyframes.reference import GRID, Reference, references, too_fast
from teleop.recording.to_keyframes.sequence_text import SequenceText, sequence_text
from teleop.sequence.compile import load_sequence

SLACK = 4  # places by which rests may give way
Trials = Sequence[Sequence[tuple[Tension, int]]]
STICK: Trials = ((EVEN, 0), (1.0, 0), (0.5, 0)), ((1.0, SLACK),), ((0.0, 0),)
PLANNED: Trials = ((EVEN, 0), (0.0, 0), (0.5, 0)), ((1.0, 0),), ((1.0, SLACK),)
"""Tension and slack to be tried, the likeliest first: a planned move has the tension of its file, `even` where that has
none; where a stick was held the speed was even. Of the first that do the sparsest is taken."""
TIGHTER = (1.0, 0.9, 0.7)  # of the tolerance, for the fit, should the whole file be further off than its parts were
HELD = 0.15  # of the time in motion at an even speed, from which on it was a stick
NEAREST = 3  # places between two keys
PER_SHARE = 100.0  # a tolerance in degrees is one in per cent for focus and sticks, whose full way is 1


@dataclass(frozen=True)
class Error:
    """The most that an axis of the new sequence is off (units), and when (s)."""

    size: float
    time: float


@dataclass(frozen=True)
class Fitted:
    """The text of a sequence file, its keyframes, and how far its plan is off, by axis."""

    text: str
    frames: Sequence[MergedKey]
    errors: Mapping[Axis, Error]


def allowed(axis: Axis, tolerance: float) -> float:
    """The tolerance in the axis's units: degrees, and for focus and sticks per cent of 1."""
    return tolerance if axis.is_angle else tolerance / PER_SHARE


def places_after_point(axis: Axis, tolerance: float) -> int:
    """Of a position in the file: rounding takes a twentieth of the tolerance at most."""
    return max(0, ceil(-log10(allowed(axis, tolerance) / 10)))


def keyframes(take: Take, tolerance: float, speed: float = 1.0, *, measured: bool = False) -> Fitted:
    """The sequence file that a take comes to; `tolerance` as `allowed` has it, `speed` is that of the take.

    Raises UnplayableError, with a line for each axis, where no keyframes can do it.
    """
    refs = references(take, speed, measured=measured)
    problems = [wrong for axis, reference in refs.items() for wrong in _too_fast(take, axis, reference, tolerance)]
    if problems:
        raise UnplayableError(problems)
    title = take.about.title if speed == 1 else f"{take.about.title} at {100 * speed:g} %"
    played = [(cue.at / speed, cue.action) for cue in cues(take) if isinstance(cue.action, Action)]
    errors: Mapping[Axis, Error] = {}
    for share in TIGHTER:
        best = _best(take, refs, share * tolerance)
        digits = {axis: places_after_point(axis, share * tolerance) for axis in refs}
        text = sequence_text(SequenceText(title, best.tension, best.frames, played, digits))
        errors = _errors(text, take, refs)
        if all(error.size <= allowed(axis, tolerance) for axis, error in errors.items()):
            return Fitted(text, best.frames, errors)
    missed = [f"{axis} {error.size:.3g} at {error.time:.2f} s" for axis, error in errors.items()]
    raise UnplayableError([f"{take.path}: the sequence file would miss the tolerance: {', '.join(missed)}"])


def _best(take: Take, refs: Mapping[Axis, Reference], tolerance: float) -> _Attempt:
    """The sparsest of the likeliest trials; raises UnplayableError where none will do."""
    held = _held(refs) > HELD
    shaped = refs if held else {axis: replace(reference, even=()) for axis, reference in refs.items()}
    fits: list[_Attempt] = []
    for trials in STICK if held else PLANNED:
        fits += [_fitted(take, shaped, tolerance, tension, slack) for tension, slack in trials]
        if any(not each.problems for each in fits):
            break
    best = min(fits, key=lambda each: (len(each.problems), len(each.frames)))
    if best.problems:
        raise UnplayableError(best.problems)
    return best


@dataclass(frozen=True)
class _Attempt:
    tension: Tension
    frames: Sequence[MergedKey]
    problems: Sequence[str]


def _held(refs: Mapping[Axis, Reference]) -> float:
    """The share of the time in motion that was made at an even speed."""
    even = sum(way.end - way.begin for reference in refs.values() for way in reference.even)
    still = sum(rest.end - rest.begin for reference in refs.values() for rest in reference.rests)
    whole = sum(len(reference.positions) - 1 for reference in refs.values())
    return even / max(whole - still, 1)


def _fitted(take: Take, refs: Mapping[Axis, Reference], tolerance: float, tension: Tension, slack: int) -> _Attempt:
    """Every axis in turn, each with its keys where those before it have some, if that is as good."""
    keys: dict[Axis, Sequence[AxisKey]] = {}
    problems: list[str] = []
    for axis, reference in refs.items():
        others = sorted({key.place for of_axis in keys.values() for key in of_axis})
        limits, digits = take.about.limits[axis], places_after_point(axis, tolerance)
        style = Style(axis, limits, allowed(axis, tolerance), digits, tension, GRID, NEAREST)
        keys[axis], unfit = _axis_keys(reference.slackened(slack), style, others)
        problems += [_out_of_reach(take, segment, off) for segment, off in unfit]
    return _Attempt(tension, [] if problems else merge_keys(keys, refs), problems)


def _axis_keys(
    reference: Reference, style: Style, others: Sequence[int]
) -> tuple[list[AxisKey], list[tuple[SampledSegment, Array | None]]]:
    """The keys of one axis, and the segments that have none that are good enough, with how far they are off."""
    keys, unfit = [], []
    for before, after in pairwise(reference.rests):
        segment = SampledSegment(before.end, reference.positions[before.end : after.begin + 1], style)
        found = fit_through(segment, planned_keys(reference.knots, before.end, after.begin))
        found = found or fit(segment, reference.corners(before.end, after.begin), others)
        if found.off is None or not segment.fits(found.off):
            unfit.append((segment, found.off))
        inner = sorted(place for place in found.keys if before.end < place < after.begin)
        keys.append(AxisKey(before.begin, segment.position(before.end), before.end - before.begin))
        keys += [AxisKey(place, found.keys[place]) for place in inner]
    last = reference.rests[-1]
    end = SampledSegment(last.begin, reference.positions[last.begin :], style).position(last.begin)
    return [*keys, AxisKey(last.begin, end, last.end - last.begin)], unfit


def _too_fast(take: Take, axis: Axis, reference: Reference, tolerance: float) -> Iterator[str]:
    limits = take.about.limits[axis]
    found = too_fast(reference, limits, HEADROOM, allowed(axis, tolerance))
    if found is not None:
        time, ahead = found
        slower = int(100 * HEADROOM * limits.velocity / float(np.abs(take.motion[axis][1]).max())) - 1
        yield (
            f"{take.path}: {axis} is too fast at {time:.2f} s: a sequence may use {HEADROOM:.0%} of its velocity limit"
            f" and would be {ahead:.3g} behind; use --speed {slower}%"
        )


def _out_of_reach(take: Take, segment: SampledSegment, off: Array | None) -> str:
    seconds = f"{segment.begin / GRID:.2f} .. {(segment.begin + len(segment.positions) - 1) / GRID:.2f} s"
    nearer = "" if off is None else f" closer than {float(np.abs(off).max()):.3g}"
    return (
        f"{take.path}: {segment.style.axis}, {seconds}: keyframes cannot follow the take{nearer}"
        f" within {HEADROOM:.0%} of its limits; use a lower --speed or a higher --tolerance"
    )


def _errors(text: str, take: Take, refs: Mapping[Axis, Reference]) -> Mapping[Axis, Error]:
    """How far off the file is when it is read and planned as `play` does it."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "fitted.yaml"
        file.write_text(text, encoding="utf-8")
        move = load_sequence(str(file), take.about.limits, take.about.rig).move
    errors = {}
    for axis, reference in refs.items():
        times = np.arange(len(reference.positions)) / GRID
        off = np.abs(move.tracks[axis].sample(times)[0] - reference.positions)
        errors[axis] = Error(float(off.max()), float(times[off.argmax()]))
    return errors
