"""What is learned about a move on a rig: an offset of each axis's commanded motion over the move's own time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from teleop.core.axes import Axis, Limits
from teleop.learning.room import fits
from teleop.planner.offset_track import added
from teleop.planner.trajectory import Move, Track


@dataclass(frozen=True)
class Error:
    """Planned less measured over a pass, in units: the worst is at `at` s of the move."""

    readings: int
    rms: float
    worst: float
    at: float


PassErrors = Mapping[Axis, Error]


@dataclass(frozen=True)
class PassFigures:
    """How well a pass was met; `ignored` is why it taught nothing, "" for one that counted."""

    number: int
    errors: PassErrors
    ignored: str = ""


@dataclass(frozen=True, eq=False)
class Correction:
    """For the rig and the sequence with this fingerprint. `passes` are those that it was learned from.

    An offset begins and ends at 0, at rest; `best` has the number of the pass whose offset each axis has.
    """

    rig: str
    title: str
    sequence: str
    offsets: Mapping[Axis, Track]
    best: Mapping[Axis, int]
    passes: Sequence[PassFigures]

    @property
    def lead(self) -> float:
        """How long before the move's own zero it begins, in s."""
        return max([0.0, *(-float(offset.breaks[0]) for offset in self.offsets.values())])

    def applied(self, move: Move) -> Move:
        """The move with its offsets."""
        tracks = {
            axis: added(track, self.offsets[axis]) if axis in self.offsets else track
            for axis, track in move.tracks.items()
        }
        return replace(move, tracks=tracks)

    def exceeds(self, move: Move, limits: Mapping[Axis, Limits]) -> list[Axis]:
        """The axes that it would take beyond their limits."""
        peaks = self.applied(move).peaks()
        return [axis for axis in self.offsets if axis in peaks and not fits(peaks[axis], limits[axis])]
