"""Keyframes that aim at a point become keys of pan and tilt.

Two keyframes in a row with one target keep it in sight while the base moves between them: there keys are set so
closely that the path between them stays on the target too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from teleop.config.documents.document import Location, numbered
from teleop.config.quantities import seconds
from teleop.core.axes import Axis
from teleop.planner.aim import AimError, Point, look_at, nearest_turn
from teleop.planner.keyframes.keys import Key
from teleop.sequence.base_path import BaseKey, BasePath
from teleop.sequence.easing import Ramps, ramps

if TYPE_CHECKING:
    from teleop.planner.trajectory import Move
    from teleop.sequence.model import Keyframe, SequenceModel

MOST_MISSED = 0.1  # deg: an aim that is further off between its keys is refused
BEND = 0.02  # deg from a straight line, of pan and tilt between two keys
CLOSEST = 0.1  # s between two keys
GRADE = 2.1  # times as far apart as their neighbors, at most
CHECKS = 50  # a second, of the finished path
ON_THE_WAY = "on the way from "  # begins what a key is called that stands in no file

Angles = tuple[float, float]  # pan and tilt in deg


class UnaimedError(Exception):
    """An aim that is none: where that stands in the file, and why."""

    def __init__(self, place: Location, text: str) -> None:
        super().__init__(text)
        self.place = place


class Look(NamedTuple):
    """A keyframe that aims: its number in the file from 0, when (s), at what (m), with which offset (deg)."""

    keyframe: int
    at: float
    hold: float
    target: Point
    offset: Angles
    stop: bool
    eases: Ramps

    def sees_the_same(self, other: Look) -> bool:
        return self.target == other.target and self.offset == other.offset


@dataclass(frozen=True)
class Tracked:
    """From `begin` to `end` (s, by the file) `scene` keeps the target of `look` in sight; `last` has its last key."""

    scene: Scene
    look: Look
    begin: float
    end: float
    last: bool

    def times(self) -> list[float]:
        """When to have keys, so that pan and tilt between them are all but straight; without the end of all."""
        rows = self.scene.base.times(self.begin, self.end)
        found = [rows[0]]
        for before, after in pairwise(rows):
            found += [*self._between(before, after), after]
        graded = _graded(found)
        return graded if self.last else graded[:-1]

    def missed(self, move: Move, clock: Callable[[float], float]) -> tuple[float, float]:
        """How far off the aim is at most, in deg, and when in the move (s); `clock` gives its time from the file's."""
        times = np.linspace(self.begin, self.end, max(int((self.end - self.begin) * CHECKS), 2) + 1)
        reached = [move.at(clock(time)) for time in times.tolist()]
        missed = []
        for time, states in zip(times.tolist(), reached, strict=True):
            pan, tilt = states[Axis.PAN].position, states[Axis.TILT].position
            wanted = self.scene.angles(self.look, time, pan)
            missed.append(max(abs(pan - wanted[0]), abs(tilt - wanted[1])))
        worst = int(np.argmax(missed))
        return missed[worst], clock(float(times[worst]))

    def _between(self, begin: float, end: float) -> list[float]:
        if end - begin < 2 * CLOSEST:
            return []
        times = np.linspace(begin, end, 5).tolist()
        angles = [self.scene.angles(self.look, begin)]
        angles += [self.scene.angles(self.look, time, angles[0][0]) for time in times[1:]]
        straight = np.linspace(angles[0], angles[-1], 5)
        if float(np.abs(straight - np.array(angles)).max()) <= BEND:
            return []
        return [*self._between(begin, times[2]), times[2], *self._between(times[2], end)]


def _graded(times: Sequence[float]) -> list[float]:
    """With more times, until none is further from the next than GRADE times its neighbors are: a path rings there."""
    while True:
        gaps = np.diff(times)
        around = np.minimum(np.append(gaps[1:], math.inf), np.insert(gaps[:-1], 0, math.inf))
        wide = np.flatnonzero((gaps > GRADE * around) & (gaps > 2 * CLOSEST))
        if len(wide) == 0:
            return list(times)
        times = sorted([*times, *((times[index] + times[index + 1]) / 2 for index in wide.tolist())])


class Scene:
    """What a file says of targets and of where the camera is: `base` is its place over time. Raises UnaimedError."""

    def __init__(self, model: SequenceModel) -> None:
        self._model = model
        everywhere = ramps(model.ease, model.fps)
        self._eases = [ramps(frame.ease, model.fps, everywhere) for frame in model.keyframes]
        self._times = [(seconds(each.at, model.fps), seconds(each.hold, model.fps)) for each in model.keyframes]
        try:
            self.base = BasePath(list(self._base_keys()))
        except AimError as error:
            raise UnaimedError(("keyframes",), str(error)) from None

    def angles(self, look: Look, time: float, near: float | None = None) -> Angles:
        """Pan and tilt in deg at a time in s; the pan within half a turn of `near`. Raises UnaimedError."""
        base = self.base.at(time)
        try:
            pan, tilt = look_at(look.target, base._replace(z=base.z + self._model.mount.height))
        except AimError as error:
            raise UnaimedError(("keyframes", look.keyframe, "aim"), str(error)) from None
        pan, tilt = pan + look.offset[0], tilt + look.offset[1]
        return (pan if near is None else nearest_turn(pan, near)), tilt

    def tracked(self) -> Iterator[Tracked]:
        """The times at which a target is kept in sight while the base moves."""
        for look, after in self._looks():
            goes_on = after is not None and after.sees_the_same(look)
            end = after.at if after is not None and goes_on else look.at + look.hold
            if self.base.moves(look.at, end):
                yield Tracked(self, look, look.at, end, last=not goes_on)

    def keys(self) -> Mapping[Axis, Sequence[Key]]:
        """The keys of pan and of tilt, none without an aim. Raises UnaimedError."""
        tracked = {each.look.keyframe: each for each in self.tracked()}
        keys: dict[Axis, list[Key]] = {Axis.PAN: [], Axis.TILT: []}
        near: float | None = None
        followed_until = -math.inf
        for look, _ in self._looks():
            following = tracked.get(look.keyframe)
            arrive, leave = look.eases
            own = Key(look.at, 0.0, look.stop, look.hold, numbered("keyframes", look.keyframe), arrive, leave)
            if followed_until == look.at:
                own = replace(own, arrive=None)  # to follow is all that the way here is for
            rows = [own]
            if following is not None:
                own = replace(own, hold=0.0, leave=None)
                rows = [own, *(Key(time, 0.0, where=ON_THE_WAY + own.where) for time in following.times()[1:])]
                followed_until = following.end
            for key in rows:
                angles = self.angles(look, key.at, near)
                near = angles[0]
                follows = following is not None and not (following.last and key is rows[-1])
                for (axis, of_axis), angle in zip(keys.items(), angles, strict=True):
                    # where it follows, how far it is off is checked, by less than is usual of an overshoot
                    overshoot = None if follows else self._model.overshoot_of(axis)
                    of_axis.append(replace(key, position=angle, overshoot=overshoot))
        return {axis: of_axis for axis, of_axis in keys.items() if of_axis}

    def _looks(self) -> Iterator[tuple[Look, Look | None]]:
        """Each keyframe that aims, and the next one if that aims too and nothing else turns the camera between them."""
        frames = enumerate(self._model.keyframes)
        turning = [
            self._look(index, frame)
            for index, frame in frames
            if frame.aim is not None or frame.pan is not None or frame.tilt is not None
        ]
        for look, after in pairwise([*turning, None]):
            if look is not None:
                yield look, after

    def _look(self, index: int, frame: Keyframe) -> Look | None:
        if frame.aim is None:
            return None
        target = frame.aim if isinstance(frame.aim, Point) else self._model.targets[frame.aim]
        offset = (frame.offset.pan, frame.offset.tilt) if frame.offset else (0.0, 0.0)
        return Look(index, *self._times[index], target, offset, frame.pass_ == "stop", self._eases[index])

    def _base_keys(self) -> Iterator[BaseKey]:
        rows = zip(self._model.keyframes, self._times, self._eases, strict=True)
        for index, (frame, times, eases) in enumerate(rows):
            if frame.base is not None:
                where = numbered("keyframes", index)
                yield BaseKey(frame.base, Key(times[0], 0.0, frame.pass_ == "stop", times[1], where, *eases))
