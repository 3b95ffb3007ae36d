"""A path of another program as a sequence file: sparse keys whose own plan stays within a tolerance of its frames.

Where all axes rest for a while they hold, and each way between two rests is fitted by itself, as a table in a sequence
is (`planner/keyframes/frames`). Points of a curve that the file has as keys are tried first. The finished text is read
and planned as `play` will do it, and that error is what the user sees.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from teleop.app.imported_keys import ImportedKeys, Way, keys_of_ways, rested_cues, text_of
from teleop.app.imported_ways import fewer, own_grid, ways_of
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.core.axes import Axis, Limits
from teleop.interchange.motion import MOST_FRAMES, Motion, TimedCue, shown
from teleop.planner.keyframes.frame_keys import Frames
from teleop.planner.keyframes.frames import FrameFitter, FramesFit, NoRoomError, TooFastError
from teleop.planner.polynomial import Array
from teleop.sequence.compile import CompiledSequence, load_sequence
from teleop.sequence.tables.fitted_table import furthest_outside, within_turns

TIGHTER = (1.0, 0.8, 0.6)  # of the tolerance, for the fit, should the whole file be further off than its parts were
PER_SHARE = 100.0  # a tolerance in degrees is one in per cent for focus and sticks, whose full way is 1
STILL = 1e-6  # of the tolerance: what rests does not move by more from frame to frame
ROUNDS = 6  # of a factor by which a path is stretched


@dataclass(frozen=True)
class Deviation:
    """The most that an axis of the new sequence is off (units), when (s), and at which frame of the file."""

    size: float
    time: float
    frame: int


@dataclass(frozen=True)
class Imported:
    """The text of a sequence file, how many keyframes it has, how far off its plan is, and lines for the user."""

    text: str
    keyframes: int
    deviations: Mapping[Axis, Deviation]
    sequence: CompiledSequence
    remarks: Sequence[str]


@dataclass(frozen=True)
class Importer:
    """Makes a sequence file of the file called `name`, for a rig with these limits; `tolerance` in degrees."""

    name: str
    limits: Mapping[Axis, Limits]
    rig: str
    tolerance: float = 0.1
    may_stretch: bool = False

    def sequence(self, motion: Motion, about: Sequence[str]) -> Imported:
        """`about` are the comments of the new file.

        Raises UnplayableError where the rig is in the way, DocumentError for what no sequence can hold.
        """
        if not motion.positions:
            return self._cues_alone(motion, about)
        motion = self._on_grid(self._for_rig(motion))
        problems = [
            text
            for axis, column in motion.positions.items()
            if (text := self._beyond(motion, axis, column)) is not None
        ]
        if problems:
            raise UnplayableError(problems)
        failures: list[DocumentError] = []
        for keys in self._attempts(motion):
            try:
                found = self._made(motion, keys, rested_cues(motion, keys), about)
            except DocumentError as error:
                failures.append(error)
                continue
            if all(off.size <= self._allowed(axis) for axis, off in found.deviations.items()):
                return found
            missed = [f"{axis} {off.size:.3g} at frame {off.frame}" for axis, off in found.deviations.items()]
            text = f"{self.name}: the sequence would miss the tolerance ({', '.join(missed)}): use a higher --tolerance"
            failures.append(UnplayableError([text]))
        raise failures[-1]

    def _allowed(self, axis: Axis) -> float:
        return self.tolerance if axis.is_angle else self.tolerance / PER_SHARE

    def _for_rig(self, motion: Motion) -> Motion:
        """The path in the turn of the soft limits. Raises UnplayableError for an axis that the rig does not have."""
        missing = [axis.value for axis in motion.axes if axis not in self.limits]
        if missing:
            rest = ", ".join(axis.value for axis in motion.axes if axis in self.limits) or "none"
            text = f"moves {', '.join(missing)}, but {self.rig} has only {', '.join(self.limits)}"
            raise UnplayableError([f"{self.name}: {text}: give --only for the axes to take, as in --only {rest}"])
        positions = {
            axis: within_turns(column, self.limits[axis]) if axis.is_angle else column
            for axis, column in motion.positions.items()
        }
        return replace(motion, positions=positions)

    def _on_grid(self, motion: Motion) -> Motion:
        """With a frame for each row of an even grid: that of its rate, or of the times of its rows."""
        rate = motion.rate or own_grid(motion.times)
        places = motion.times * float(rate)
        count = math.ceil(float(places[-1]) - 1e-6) + 1
        if count > MOST_FRAMES:
            raise DocumentError([f"{self.name}: is too long: {count} frames, and at most {MOST_FRAMES}"])
        whole = np.round(places).astype(int)
        if np.abs(places - whole).max() < 1e-3 and len(np.unique(whole)) == len(whole):
            gaps = {axis: np.full(count, math.nan) for axis in motion.axes}
            for axis, column in motion.positions.items():
                gaps[axis][whole] = column
            lines = np.zeros(count, dtype=int)
            lines[whole] = motion.lines if len(motion.lines) else 0
            return replace(motion, positions=gaps, times=np.arange(count) / float(rate), lines=lines.tolist())
        times = np.minimum(np.arange(count) / float(rate), motion.times[-1])
        positions = {axis: np.interp(times, motion.times, column) for axis, column in motion.positions.items()}
        return replace(motion, positions=positions, times=np.arange(count) / float(rate), lines=(), corners=())

    def _beyond(self, motion: Motion, axis: Axis, column: Array) -> str | None:
        """A line for an axis that leaves the soft limits: the frame at which it is furthest outside."""
        limits = self.limits[axis]
        worst = furthest_outside(column, limits)
        if worst is None:
            return None
        reach, frame = f"{limits.minimum:g}..{limits.maximum:g} ({self.rig})", motion.first + worst
        return f"{self._line(motion, worst)}: frame {frame}: {axis} must be within {reach}, not {column[worst]:g}"

    def _line(self, motion: Motion, place: int) -> str:
        """The file, and the line that has the frame at `place`, as far as it is known."""
        return f"{self.name}:{motion.lines[place]}" if len(motion.lines) and motion.lines[place] else self.name

    def _attempts(self, motion: Motion) -> Iterator[ImportedKeys]:
        grid = motion.rate or own_grid(motion.times)
        if len(motion.times) == 1:
            yield ImportedKeys.at_places(motion, [0], grid)
            return
        if 1 < len(motion.corners) < len(motion.times) / 4:
            yield ImportedKeys.at_places(motion, motion.corners, grid)
        for share in TIGHTER:
            yield self._fitted(motion, grid, share)

    def _fitted(self, motion: Motion, grid: Fraction, share: float) -> ImportedKeys:
        """Way by way, from rest to rest; all of them as much slower as the slowest has to be."""
        still = {axis: STILL * self._allowed(axis) for axis in motion.axes}
        spans = list(ways_of(motion, still, float(grid)))
        if not spans:
            return ImportedKeys.at_rest(motion, grid)
        factor = 1.0
        for _ in range(ROUNDS):
            ways = [Way(begin, end, self._fit(motion, begin, end, float(grid) / factor, share)) for begin, end in spans]
            slower = max((way.fit.factor for way in ways), default=1.0)
            if slower <= 1.0:
                return keys_of_ways(ways, motion, grid, factor)
            factor *= slower
        raise UnplayableError([f"{self.name}: cannot be stretched to what {self.rig} can do"])

    def _fit(self, motion: Motion, begin: int, end: int, rate: float, share: float) -> FramesFit:
        """The keys of one way. Raises UnplayableError."""
        tables = [
            Frames(axis, column[begin : end + 1], share * self._allowed(axis), self.limits[axis])
            for axis, column in motion.positions.items()
        ]
        up: tuple[float | None, ...] = (0.0,) if begin > 0 else (0.0, None)
        out: tuple[float | None, ...] = (0.0,) if end < len(motion.times) - 1 else (0.0, None)
        for runs in product(up, out):  # a file that begins at rest does not say so
            found = FrameFitter(tables, rate, *runs).as_asked()
            if found is not None:
                return replace(found, keys={table.axis: fewer(table, found, rate) for table in tables})
        try:
            return FrameFitter(tables, rate, up[-1], out[-1]).fit(may_stretch=self.may_stretch)
        except TooFastError as error:
            raise UnplayableError([self._too_fast(error, motion, begin)]) from None
        except NoRoomError as error:
            what = "come to rest after the last frame" if error.after else "get to speed before the first frame"
            raise UnplayableError([f"{self.name}: {error.axis} cannot {what} within its limits ({self.rig})"]) from None

    def _too_fast(self, error: TooFastError, motion: Motion, begin: int) -> str:
        place = begin + error.place
        what = f"{self._line(motion, place)}: {error.axis} is too fast for {self.rig}"
        if error.share > 1:
            what += f" (its {error.limit} would be {error.share:.3g} x the limit at frame {motion.first + place})"
        cure = "a higher --tolerance" if error.factor is None else "--stretch, or a higher --tolerance"
        if error.factor is not None and motion.rate is not None:
            slower = math.floor(1000 * motion.rate / error.factor) / 1000
            cure = f"--rate {slower:g} ({float(motion.rate) / slower:.2f} x slower), {cure}"
        return f"{what}; use {cure}"

    def _made(self, motion: Motion, keys: ImportedKeys, cues: Sequence[TimedCue], about: Sequence[str]) -> Imported:
        """The file of these keys and cues, read and planned as `play` does it."""
        text = text_of(keys, replace(motion, cues=cues), about)
        with TemporaryDirectory() as folder:
            file = Path(folder) / "imported.yaml"
            file.write_text(text, encoding="utf-8")
            try:
                sequence = load_sequence(str(file), self.limits, self.rig)
            except DocumentError as error:
                problems = [each.replace(str(file), f"{self.name} as a sequence") for each in error.problems]
                raise type(error)(problems, error.more) from None
        deviations = {}
        times = keys.begin + motion.times * keys.factor
        for axis, column in motion.positions.items():
            off = np.nan_to_num(np.abs(sequence.move.tracks[axis].sample(times)[0] - column))
            worst = int(off.argmax())
            deviations[axis] = Deviation(float(off[worst]), float(times[worst]), motion.first + worst)
        return Imported(text, len(keys.lines), deviations, sequence, list(_remarks(keys, motion, cues)))

    def _cues_alone(self, motion: Motion, about: Sequence[str]) -> Imported:
        """Cues without a path, beside one key that stays where the rig is put: at the center."""
        axes = [axis for axis in (Axis.PAN, Axis.TILT) if axis in self.limits] or list(self.limits)[:1]
        text = "the file has cues and no path: its one keyframe is a placeholder; put your own keyframes there"
        motion = replace(motion, positions={axis: np.zeros(1) for axis in axes}, times=np.zeros(1))
        keys = ImportedKeys.at_places(motion, [0], Fraction(1))
        found = self._made(motion, keys, motion.cues, [*about, text])
        return replace(found, remarks=[text])


def _remarks(keys: ImportedKeys, motion: Motion, cues: Sequence[TimedCue]) -> Iterator[str]:
    if keys.begin > 0:
        yield f"it begins {keys.begin:.2f} s before the file's first frame, to be at speed there"
    for cue, moved in zip(motion.cues, cues, strict=True):
        if cue.at != moved.at:
            yield f"cue {cue.name!r} is {moved.at - cue.at:+.3f} s off, to be where all axes rest"
    if keys.factor > 1:
        rate = "" if motion.rate is None else f": its frames go by at {shown(motion.rate / Fraction(keys.factor))}"
        yield f"stretched {keys.factor:.3f} x{rate}"
