"""A planned move as a program sees it: its states, its samples, its picture."""

# pyright: strict

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from teleop.config.profile import Profile
from teleop.core.axes import Axis, State
from teleop.core.errors import UsageError
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Peaks
from teleop.sequence.compile import CompiledSequence

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Samples(NDArray[np.float64]):
    """The motion of one axis at n times: an array (4, n) with the rows position, velocity, acceleration and jerk.

    Units are degrees and s, for focus its share of the range. `.position` is row 0, and so on.
    """

    @property
    def position(self) -> Array:
        return np.asarray(self)[0]

    @property
    def velocity(self) -> Array:
        return np.asarray(self)[1]

    @property
    def acceleration(self) -> Array:
        return np.asarray(self)[2]

    @property
    def jerk(self) -> Array:
        return np.asarray(self)[3]


@dataclass(frozen=True, eq=False, repr=False)
class Move:
    """A sequence compiled for a rig: what every axis does at every time, checked against the rig's limits."""

    compiled: CompiledSequence
    profile: Profile

    @property
    def title(self) -> str:
        return self.compiled.title

    @property
    def axes(self) -> tuple[Axis, ...]:
        return tuple(self.compiled.move.tracks)

    @property
    def duration(self) -> float:
        """Seconds from 0 to the end of the motion."""
        return self.compiled.move.duration

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the planner remarks on, a line each."""
        return tuple(self.compiled.warnings)

    def at(self, time: float) -> dict[str, State]:
        """By axis name its `State(position, velocity, acceleration)`, `time` s after the start.

        Before the start and after the end the axes rest. Raises UsageError for a time that is not finite.
        """
        if not math.isfinite(time):
            raise UsageError(f"at: time={time:g} must be a finite number of seconds")
        return {axis.value: state for axis, state in self.compiled.move.at(time).items()}

    def sample(self, times: Sequence[float] | Array) -> dict[str, Samples]:
        """By axis name its motion at `times` (n,), in s: an array (4, n), whose rows have names.

        `move.sample(times)["pan"].position` is the array (n,) of positions; `.velocity`, `.acceleration` and `.jerk`
        are the other rows. Raises UsageError for times that are not a flat list of finite numbers.
        """
        try:
            at = np.asarray(times, float)
        except (TypeError, ValueError):
            raise UsageError("sample: times must be numbers of seconds") from None
        if at.ndim != 1 or not np.all(np.isfinite(at)):
            raise UsageError("sample: times must be a flat list of finite numbers of seconds")
        return {axis.value: rows.view(Samples) for axis, rows in self.compiled.move.sample(at).items()}

    def peaks(self) -> dict[str, Peaks]:
        """By axis name its exact extremes: velocity, acceleration, jerk, and the range of positions."""
        return {axis.value: peaks for axis, peaks in self.compiled.move.peaks().items()}

    def plot(self) -> Figure:
        """A matplotlib figure with a panel each for position, velocity, acceleration and jerk.

        Raises UsageError without matplotlib, which the extra `plot` brings.
        """
        from teleop.plots.drawing import figure

        try:
            return figure(self.compiled, self.profile)
        except ImportError:
            raise UsageError("plot needs matplotlib: pip install 'rs-teleop[plot]'") from None

    def __repr__(self) -> str:
        return f"<Move {self.title!r}: {self.duration:.2f} s of {', '.join(self.axes)} on {self.profile.name}>"

    def _repr_html_(self) -> str:
        """The interactive preview, for a notebook."""
        from teleop.plots.page import page

        text = escape(page(self.compiled, self.profile), quote=True)
        return f'<iframe srcdoc="{text}" style="width: 100%; height: 720px; border: 0"></iframe>'
