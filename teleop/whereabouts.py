"""After a stall of the computer: where the axes are by now, from fresh readings, and how fast.

A gimbal forgets a speed after 0.5 s and a position after 0.1 s, so what was commanded before a stall says little. Two
readings of an axis taken since say where it is; an axis without them, after a while, goes on as it was planned.
"""

from __future__ import annotations

from collections.abc import Mapping

from teleop.motion import Axis, Motion, Reading, State

PATIENCE = 0.3  # s to wait for two readings of every axis


class Whereabouts:
    """The axes that `motion` has moving, looked for since a stall ended at `since`, on the loop's clock."""

    def __init__(self, motion: Motion, since: float) -> None:
        self._since = since
        self._commanded = {axis: state for axis, state in motion.items() if state.velocity or state.acceleration}
        self._readings: dict[Axis, list[Reading]] = {axis: [] for axis in self._commanded}  # the last two of each

    def known(self, now: float, reported: Mapping[Axis, Reading]) -> bool:
        """Whether nothing more is to be waited for, with what has been reported by `now`."""
        for axis, readings in self._readings.items():
            reading = reported[axis]
            if reading.time >= self._since and reading not in readings[-1:]:
                self._readings[axis] = [*readings[-1:], reading]
        return now >= self._since + PATIENCE or all(len(readings) == 2 for readings in self._readings.values())

    def found(self, now: float) -> Motion:
        """The axes that were found, where they are at `now`.

        None can be faster than it was commanded, nor have turned round, whatever two rounded readings seem to say.
        """
        motion = {}
        for axis, readings in self._readings.items():
            if len(readings) == 2:
                (before, earlier), (position, later) = readings
                low, high = sorted((0.0, self._commanded[axis].velocity))
                velocity = min(max((position - before) / (later - earlier), low), high)
                motion[axis] = State(position + velocity * (now - later), velocity)
        return motion
