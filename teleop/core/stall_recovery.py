"""After a stall of the computer: where the axes are by now, from fresh readings, and how fast.

A gimbal forgets a speed after 0.5 s and a position after 0.1 s, so what was commanded before a stall is no guide. Two
readings of an axis taken at different times since say where it is and how fast. The search has a deadline. By then
every device has long stopped by itself, so an axis that was read once is held where it was read, and an axis that was
not read at all gets no command: any position for it would be made up.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from teleop.core.axes import Axis, Motion, Reading, State

READINGS_TIMEOUT = 0.3  # s to wait for two readings of every axis


class StallRecovery:
    """The axes that `motion` has moving, looked for since a stall ended at `since`, on the loop's clock."""

    def __init__(self, motion: Motion, since: float) -> None:
        self._since = since
        self._commanded = {axis: state for axis, state in motion.items() if state.velocity or state.acceleration}
        self._readings: dict[Axis, list[Reading]] = {axis: [] for axis in self._commanded}  # the last two of each

    def known(self, now: float, reported: Mapping[Axis, Reading]) -> bool:
        """Whether the search is over at `now`, with what has been reported by then: all found, or past the deadline.

        Of two readings with the same time the later one counts, alone: they say nothing about a speed.
        """
        for axis, readings in self._readings.items():
            reading = reported.get(axis)
            if reading is None or not math.isfinite(sum(reading)) or not self._since <= reading.time <= now:
                continue
            if readings and reading.time < readings[-1].time:
                continue
            earlier = [each for each in readings if each.time < reading.time]
            self._readings[axis] = [*earlier[-1:], reading]
        return now >= self._since + READINGS_TIMEOUT or all(len(readings) == 2 for readings in self._readings.values())

    def found(self, now: float) -> Motion:
        """The axes that were read since, where they are at `now`; those read once are at rest.

        None can be faster than it was commanded, nor have turned round, whatever two rounded readings seem to say.
        """
        motion = {}
        for axis, readings in self._readings.items():
            if len(readings) == 2:
                (before, earlier), (position, later) = readings
                low, high = sorted((0.0, self._commanded[axis].velocity))
                velocity = min(max((position - before) / (later - earlier), low), high)
                motion[axis] = State(position + velocity * (now - later), velocity)
            elif readings:
                motion[axis] = State(readings[0].position)
        return motion

    @property
    def read_once(self) -> Sequence[Axis]:
        """The axes of which one reading has come: enough to hold them there."""
        return [axis for axis, readings in self._readings.items() if len(readings) == 1]

    @property
    def unread(self) -> Sequence[Axis]:
        """The axes of which nothing is known since the stall."""
        return [axis for axis, readings in self._readings.items() if not readings]
