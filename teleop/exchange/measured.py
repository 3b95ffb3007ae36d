"""Where each axis was at an instant, from readings that come late, unevenly and each with a time of its own.

A reading is what a device measured and when. The way between two readings is a cubic with the slopes of their
neighbors, which is exact for an even acceleration: 40 ms at 240 deg/s2 bend a way by 0.05 degrees. A little beyond the
newest reading the axis is taken to go on at its speed, then to stay. Angles are continued over +-180 degrees.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from teleop.core.axes import Axis

KEPT = 64  # readings of an axis: 2.5 s of a gimbal that answers 25 times a second
SAME = 5e-4  # s: closer together than this it is the same reading, whose time was rounded
BEYOND = 0.05  # s past the newest reading that an axis is taken to go on
LONGEST = 0.25  # s between two readings that say something of the way beside them


class At(NamedTuple):
    """Where an axis was. `age` is from the newest reading to the instant asked for, in s: below 0 for one between
    readings; `beyond` whether it is no more than the axis's way going on."""

    position: float
    age: float

    @property
    def beyond(self) -> bool:
        return self.age > 0


class Readings:
    """The newest readings of one axis, in the order of their times. `turns`: its positions are angles in degrees."""

    def __init__(self, turns: bool) -> None:
        self._turns = turns
        self._times: list[float] = []
        self._positions: list[float] = []

    def add(self, time: float, position: float) -> None:
        """A reading, in any order; one that is known already changes nothing."""
        place = bisect_left(self._times, time - SAME)
        if place < len(self._times) and self._times[place] <= time + SAME:
            return
        if place == 0 and len(self._times) >= KEPT:
            return  # older than all that is kept
        if self._turns and self._times:
            near = self._positions[place - 1] if place else self._positions[0]
            position += 360.0 * round((near - position) / 360.0)
        self._times.insert(place, time)
        self._positions.insert(place, position)
        if len(self._times) > KEPT:
            del self._times[0], self._positions[0]

    @property
    def newest(self) -> float | None:
        """The time of the newest reading, in s."""
        return self._times[-1] if self._times else None

    def at(self, instant: float) -> At | None:
        """At `instant` (s); None before the first reading."""
        if not self._times or instant < self._times[0]:
            return None
        age = instant - self._times[-1]
        if age >= 0:
            return At(self._positions[-1] + self._slope() * min(age, BEYOND), age)
        place = bisect_left(self._times, instant)
        return At(self._between(place - 1, instant), age) if place else At(self._positions[0], age)

    def _between(self, left: int, instant: float) -> float:
        """On the cubic from reading `left` to the next one."""
        seconds = self._times[left + 1] - self._times[left]
        share = (instant - self._times[left]) / seconds
        begin, end = self._positions[left], self._positions[left + 1]
        slope = end - begin
        bent = share * (1 - share) * seconds
        return (
            begin
            + share * slope
            + bent
            * (
                (1 - share) * (self._tangent(left, left) - slope / seconds)
                - share * (self._tangent(left + 1, left) - slope / seconds)
            )
        )

    def _tangent(self, place: int, beside: int) -> float:
        """The slope at reading `place`: of the parabola through it and its neighbors, for the way from `beside` on."""
        other = 2 * place - 1 - beside  # the way on its other side
        own = self._way(beside)
        if 0 <= other < len(self._times) - 1 and self._seconds(other) <= LONGEST:
            return (own * self._seconds(other) + self._way(other) * self._seconds(beside)) / (
                self._seconds(other) + self._seconds(beside)
            )
        further = beside + (beside - place) * 2 + 1  # the way beyond the other end
        if 0 <= further < len(self._times) - 1 and self._seconds(further) <= LONGEST:
            bend = (own - self._way(further)) / (self._seconds(further) + self._seconds(beside))
            return own + bend * self._seconds(beside)
        return own

    def _seconds(self, left: int) -> float:
        return self._times[left + 1] - self._times[left]

    def _way(self, left: int) -> float:
        """The mean speed from reading `left` to the next one."""
        return (self._positions[left + 1] - self._positions[left]) / self._seconds(left)

    def _slope(self) -> float:
        """At the newest reading."""
        if len(self._times) < 2 or self._seconds(len(self._times) - 2) > LONGEST:
            return 0.0
        return self._way(len(self._times) - 2)


class Measured:
    """The readings of every axis, taken from the states of a rig. Times are the machine's monotonic clock, in s."""

    def __init__(self) -> None:
        self._axes: dict[Axis, Readings] = {}

    def take(self, state: Mapping[str, Any]) -> None:
        """The readings of a state, as the rig wrote it."""
        for name, axis in state.get("axes", {}).items():
            position, age = axis["measured"], axis["measured_age_ms"]
            if position is not None and age is not None:
                self.add(Axis(name), state["time"] - age / 1000, position)

    def add(self, axis: Axis, time: float, position: float) -> None:
        readings = self._axes.get(axis)
        if readings is None:
            readings = self._axes[axis] = Readings(axis.is_angle)
        readings.add(time, position)

    def at(self, axis: Axis, instant: float) -> At | None:
        """Where `axis` was at `instant`; None where nothing was measured by then."""
        readings = self._axes.get(axis)
        return None if readings is None else readings.at(instant)

    def newest(self, axes: Iterable[Axis]) -> float | None:
        """The time of the newest reading of the axis that was not measured for the longest time; None without one."""
        times = [readings.newest for axis in axes if (readings := self._axes.get(axis)) is not None]
        known = [time for time in times if time is not None]
        return min(known) if known else None

    def knows(self, axes: Iterable[Axis]) -> bool:
        """Whether each of `axes` was measured."""
        return all(axis in self._axes for axis in axes)
