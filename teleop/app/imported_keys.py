"""The keyframes of an imported path, and the text of their sequence file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.config.frame_rates import exact, shown_rate
from teleop.core.axes import Axis
from teleop.core.timing import SAME_TIME
from teleop.interchange.motion import Motion, TimedCue
from teleop.planner.keyframes.frames import FramesFit
from teleop.sequence.cues import CueSection
from teleop.sequence.written_values import decimal, keyframe, quoted

SECONDS = 1000  # places in a second of a file without a frame rate
DIGITS = {True: 4, False: 5}  # behind the point, of angles and of shares
CONSTANT = 1e-9  # units
SLOW = 0.02  # of the fastest step of an axis: a key with less before and after it is a stop
RESTED = 0.2  # s: a shorter rest is a turning point, or at the end no hold
NEAR_REST = 2  # frames by which a cue that needs rest may be off it
ANY_WAY = 360  # overshoot of keys that are samples of a curve: any


class Line(NamedTuple):
    """A keyframe, `place` frames after the sequence's zero, that holds for so many frames."""

    place: int
    positions: Mapping[Axis, float]
    hold: int = 0
    stop: bool = False


class Way(NamedTuple):
    """From one rest to the next, by the indices of their frames, and the keys between."""

    begin: int
    end: int
    fit: FramesFit


@dataclass(frozen=True)
class ImportedKeys:
    """`up` frames of a run-up come before the file's first frame; all times are `factor` times those of the file.

    `grid` is how many places there are in a second. `sampled`: keys are samples of a curve, not set by a person.
    """

    lines: Sequence[Line]
    grid: Fraction
    up: int = 0
    factor: float = 1.0
    sampled: bool = True

    @property
    def begin(self) -> float:
        """When the file's first frame is, in s."""
        return self.up * self.factor / float(self.grid)

    @classmethod
    def at_places(cls, motion: Motion, places: Sequence[int], grid: Fraction) -> ImportedKeys:
        """Keys at these frames, where the path has them."""
        lines = []
        for place in places:
            known = {axis: float(column[place]) for axis, column in motion.positions.items()}
            known = {axis: position for axis, position in known.items() if np.isfinite(position)}
            lines.append(Line(place, known, stop=_stops(motion, place)))
        return cls(lines, grid, sampled=False)

    @classmethod
    def at_rest(cls, motion: Motion, grid: Fraction) -> ImportedKeys:
        """One key that holds for as long as the path is."""
        only = cls.at_places(motion, [0], grid).lines[0]
        return cls([only._replace(hold=len(motion.times) - 1)], grid, sampled=False)


def _stops(motion: Motion, place: int) -> bool:
    """Whether every axis is about to rest there, on its way."""
    if not 0 < place < len(motion.times) - 1:
        return False
    for column in motion.positions.values():
        steps = np.abs(np.diff(column))
        if not max(steps[place - 1], steps[place]) <= SLOW * steps.max():
            return False
    return True


def keys_of_ways(ways: Sequence[Way], motion: Motion, grid: Fraction, factor: float) -> ImportedKeys:
    """The keys of all ways; where they rest the positions are those of the file."""
    up = ways[0].fit.runs.up
    found: dict[int, dict[Axis, float]] = {}
    holds: dict[int, int] = {}
    for axis, column in motion.positions.items():
        if float(np.nanmax(column) - np.nanmin(column)) <= CONSTANT:
            found.setdefault(0, {})[axis] = float(np.nanmin(column))
            continue
        for way in ways:
            keys = dict(way.fit.keys[axis])
            if len(keys) == 1 and len(ways) > 1:  # it rests on this way
                keys = {0: column[way.begin], way.end - way.begin: column[way.end]}
            for place, position in keys.items():
                at = way.begin + place
                pinned = at in (way.begin, way.end) and 0 <= at < len(column) and np.isfinite(column[at])
                pinned = pinned and not (at == 0 and up) and not (way is ways[-1] and way.fit.runs.out)
                found.setdefault(up + at, {})[axis] = float(column[at]) if pinned else position
    for before, after in pairwise(ways):
        holds[up + before.end] = after.begin - before.end
        del found[up + after.begin]
    if ways[0].begin > 0:  # it rests at first
        found[0] = found.pop(ways[0].begin, {}) | found.get(0, {})
        holds[0] = ways[0].begin
    last = len(motion.times) - 1
    if ways[-1].end < last and last - ways[-1].end >= RESTED * grid:
        holds[up + ways[-1].end] = last - ways[-1].end
    lines = [Line(place, found[place], holds.get(place, 0)) for place in sorted(found)]
    return ImportedKeys(lines, grid, up, factor)


def rested_cues(motion: Motion, keys: ImportedKeys) -> Sequence[TimedCue]:
    """The cues, those that need rest moved to it where it is a frame or two away: it begins on a frame here."""
    rests = [(line.place, line.place + line.hold) for line in keys.lines if line.hold or line.stop]
    rests += [(0, 0), (keys.lines[-1].place, math.inf)]
    found = []
    for cue in motion.cues:
        place = keys.up + cue.at * float(keys.grid)
        edges = [float(min(max(place, begin), end)) for begin, end in rests]
        nearest = min(edges, key=lambda edge, place=place: abs(edge - place))
        away = abs(nearest - place)
        needs = CueSection.model_validate({"at": 0, **cue.content}).needs_rest
        moves = needs and SAME_TIME < away <= NEAR_REST
        found.append(cue._replace(at=(nearest - keys.up) / float(keys.grid)) if moves else cue)
    return found


def text_of(keys: ImportedKeys, motion: Motion, about: Sequence[str]) -> str:
    """The YAML of the sequence, with comments first."""
    return "\n".join(_lines(keys, motion, about)) + "\n"


def _lines(keys: ImportedKeys, motion: Motion, about: Sequence[str]) -> Iterator[str]:
    yield from (f"# {line}" for line in about)
    if keys.begin > 0:
        yield f"# The file's first frame is at {keys.begin:.3f} s: what comes before gets the rig to speed."
    yield f"title: {quoted(motion.title)}"
    if motion.rate is not None:
        rate = float(motion.rate) / keys.factor
        yield f"fps: {shown_rate(rate) if keys.factor == 1 and _is_shown(motion.rate) else repr(rate)}"
    if keys.sampled:
        yield "tension: 0"
        yield f"overshoot: {ANY_WAY}"
    yield "keyframes:"
    for line in keys.lines:
        yield _keyframe(line, keys, motion)
    if motion.cues:
        yield "cues:"
    for cue in motion.cues:
        yield f"  - {{{', '.join(_cue(cue, keys))}}}"


def _is_shown(rate: Fraction) -> bool:
    """Whether its usual spelling, 23.976, means exactly this rate."""
    return exact(float(shown_rate(float(rate)))) == rate


def _keyframe(line: Line, keys: ImportedKeys, motion: Motion) -> str:
    positions = {axis: decimal(at, DIGITS[axis.is_angle]) for axis, at in line.positions.items()}
    hold = _time(line.hold, keys, motion) if line.hold else ""
    return keyframe(_time(line.place, keys, motion), positions, hold, line.stop)


def _time(place: int, keys: ImportedKeys, motion: Motion) -> str:
    if motion.rate is not None:
        return f"{place}f"
    return decimal(place / float(keys.grid) * keys.factor, 6)


def _cue(cue: TimedCue, keys: ImportedKeys) -> Iterator[str]:
    yield f"at: {decimal(keys.begin + cue.at * keys.factor, 6)}"
    for kind, value in cue.content.items():
        yield f"{kind}: {quoted(value) if kind == 'send' else value}"
