"""Moves that a rig refuses, as people have them, each with a partner of the same size that it can play.

A partner has the same keys, `slower` times later, so that the planner has the same numbers of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.ramp import Ramp
from teleop.planner.keyframes.repeat import Repeat, repeated
from teleop.sequence.panorama import PanoramaSection, shots

PAN, TILT, ROLL = Axis.PAN, Axis.TILT, Axis.ROLL
LIMITS = {
    PAN: Limits(-170, 170, 60, 120, 600),
    TILT: Limits(-30, 40, 40, 90, 480),
    ROLL: Limits(-30, 30, 40, 90, 480),
}
Keys = Mapping[Axis, Sequence[Key]]
_NEEDS = re.compile(r"(\w+) needs ([\d.]+) s .*?from key (\d+) to key (\d+), not ([\d.]+) s")
Needs = dict[tuple[str, int, int], float]


@dataclass(frozen=True)
class Refused:
    """Keys that ask for too much, and the same keys with more time."""

    keys: Keys
    slower: float

    @property
    def partner(self) -> Keys:
        return {axis: [key.later(self.slower) for key in of_axis] for axis, of_axis in self.keys.items()}


def _named(times: Iterable[float], positions: Iterable[float]) -> list[Key]:
    return [
        Key(float(at), float(position), where=f"key {index + 1}")
        for index, (at, position) in enumerate(zip(times, positions, strict=True))
    ]


def track(count: int = 80, fps: float = 24.0) -> Refused:
    """A match-move: a wander by the frame with the noise of a tracker, on three axes."""
    rng = np.random.default_rng(count)
    at = np.arange(count) / fps
    wander = {
        PAN: 15 * np.sin(at) + rng.normal(0, 0.15, count),
        TILT: 6 * np.sin(0.7 * at) + rng.normal(0, 0.15, count),
        ROLL: 2 * np.sin(1.3 * at) + rng.normal(0, 0.1, count),
    }
    return Refused({axis: _named(at, positions) for axis, positions in wander.items()}, 12.0)


def noise(count: int = 240) -> Refused:
    """Noisy keys on one axis, four of them a second."""
    rng = np.random.default_rng(count)
    return Refused({PAN: _named(np.arange(count) / 4, rng.normal(0, 8, count))}, 12.0)


def wander(count: int = 500) -> Refused:
    """A long wander on one axis, most of it slow enough."""
    rng = np.random.default_rng(count)
    positions = np.clip(np.cumsum(rng.uniform(-30, 30, count)), -160, 160)
    return Refused({PAN: _named(np.cumsum(rng.uniform(0.5, 1.2, count)), positions)}, 6.0)


def panorama(every: float = 1.2, width: float = 320.0) -> Refused:
    """Some 1200 shots with too little time from one to the next."""
    section = PanoramaSection.model_validate(
        {
            "fov": [12, 8],
            "overlap": "40%",
            "pan": [-width / 2, width / 2],
            "tilt": [-28, 38],
            "every": every,
            "exposure": 0.3,
            "settle": 0.3,
        }
    )
    return Refused(shots(section, None).keys, 3.0)


def bounce(times: int = 99) -> Refused:
    """Three keys, there and back many times."""
    keys = {PAN: _named([0, 1, 1.6], [0, 40, 60]), TILT: _named([0, 1, 1.6], [0, 20, 35])}
    return Refused(repeated(keys, times, Repeat.BOUNCE), 3.0)


def stops(count: int = 200) -> Refused:
    """Stops at random places and times: no two legs are alike."""
    rng = np.random.default_rng(count)
    keys = _named(np.cumsum(rng.uniform(0.5, 1.5, count)), rng.uniform(-100, 100, count))
    return Refused({PAN: [replace(key, stop=True) for key in keys]}, 8.0)


CASES: Mapping[str, Callable[..., Refused]] = {
    "track": track,
    "noise": noise,
    "wander": wander,
    "panorama": panorama,
    "bounce": bounce,
    "stops": stops,
}


def random_file(rng: np.random.Generator) -> dict[Axis, list[Key]]:
    """2 to 9 keyframes; each axis has most of them, in about the time that it needs or too little."""
    count = int(rng.integers(2, 10))
    at = np.concatenate([[0.0], np.cumsum(np.round(rng.uniform(0.1, 3.0, count - 1), 2))])
    keys: dict[Axis, list[Key]] = {}
    eased = Ramp(seconds=float(rng.choice([0.5, 1.0]))) if rng.random() < 0.3 else None
    for axis in rng.permutation(list(LIMITS))[: rng.integers(1, 4)]:
        limits = LIMITS[Axis(axis)]
        of_axis = []
        for index, time in enumerate(at):
            if rng.random() < 0.85 or index in (0, count - 1):
                position = float(np.round(rng.uniform(limits.minimum, limits.maximum), 1))
                stop = bool(rng.random() < 0.15)
                of_axis.append(Key(float(time), position, stop, where=f"key {index + 1}", arrive=eased, leave=eased))
        keys[Axis(axis)] = of_axis
    return keys


def needs_of(error: Infeasible) -> Needs:
    """What the lines say: axis, first and last key (from 1), seconds."""
    found = [_NEEDS.match(str(finding)) for finding in error.findings]
    return {(m[1], int(m[3]), int(m[4])): float(m[2]) for m in found if m}


def asked_of(error: Infeasible) -> Needs:
    """What the keys allow for each of these."""
    found = [_NEEDS.match(str(finding)) for finding in error.findings]
    return {(m[1], int(m[3]), int(m[4])): float(m[5]) for m in found if m}


def taken(keys: Keys, needs: Needs) -> dict[Axis, list[Key]]:
    """As a user takes them: from the first key to the last, each later one moved along."""
    times = {int(key.where[4:]): key.at for of_axis in keys.values() for key in of_axis}
    moved: dict[int, float] = {}
    shift = 0.0
    for number in sorted(times):
        for (_, first, last), seconds in needs.items():
            if last == number:
                shift = max(shift, moved[first] + seconds - times[number])
        moved[number] = times[number] + shift
    return {axis: [Key(moved[int(key.where[4:])], *_rest(key)) for key in of_axis] for axis, of_axis in keys.items()}


def _rest(key: Key) -> tuple:
    return key.position, key.stop, key.hold, key.where, key.arrive, key.leave
