"""A move that chases timecode, in closed loop on a clock of its own: quarter frames in, places of axes out."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from at_once import AtOnce
from midi_sender import RATES, quarters

from teleop.core.axes import Axis, Limits, State
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import StateTarget
from teleop.core.timing import PERIOD
from teleop.exchange.timecode.mtc import MtcDecoder
from teleop.exchange.timecode.tracker import Tracker
from teleop.planner.keyframes.planner import Key, plan
from teleop.remote.follower import Follower
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cycle import Cycle
from teleop.sequence.phases import SequencePhase
from teleop.sequence.source import SequenceSource

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-56, 146, 60, 120, 600)}
KEYS = {
    Axis.PAN: [Key(0, 0), Key(3, 40), Key(6, 10), Key(20, 90)],
    Axis.TILT: [Key(1, 5), Key(8, 20), Key(20, -10)],
}
HOUR = {0: 86400, 1: 90000, 2: 107892, 3: 108000}
SAID = 0.1  # s from one word of the tracker to the next, as the server sends them


class Point(NamedTuple):
    """A tick: its time, the place of the timecode and of the move (s), and the axes."""

    time: float
    code: float
    place: float | None
    axes: dict[Axis, State]


def sender(
    rate: int, begin: float, seconds: float, jitter: float = 0.0, speed: float = 1.0, lead: float = 0.0, seed: int = 1
) -> Iterator[tuple[float, bytes]]:
    """Quarter frames with the times at which they come; the hour is `lead` s after `begin`."""
    rng = random.Random(seed)
    first = HOUR[rate] - round(lead * RATES[rate] / 2) * 2
    before = 0.0
    for pair in range(0, int(seconds * RATES[rate]), 2):
        for quarter, message in enumerate(quarters(first + pair, rate)):
            time = begin + (pair + quarter / 4) / RATES[rate] / speed + jitter * rng.random()
            before = max(before, time)
            yield before, bytes(message.bytes())


class ChaseBench:
    """A move, played as the rig does it, steered by what the tracker says."""

    def __init__(
        self,
        rate: float | None = None,
        keys: Mapping[Axis, Sequence[Key]] = KEYS,
        limits: Mapping[Axis, Limits] = LIMITS,
    ) -> None:
        compiled = CompiledSequence("Test", plan(keys, limits), [], [], keys)
        self.follower = Follower()
        cycle = Cycle(0.0, trigger=self.follower)
        self.source = SequenceSource(compiled, limits, 1.0, AtOnce(), cycle)
        self.decoder, self.tracker = MtcDecoder(rate), Tracker(rate, (1, 0, 0, 0))
        self.points: list[Point] = []
        self.faults: list[tuple[float, str]] = []
        self.now = 0.0
        self.told = False  # whether the gateway tells the move to pause once the code is lost
        start = compiled.move.at(compiled.move.opening)
        self._motion = dict(start)
        self.source.start(0.0, start)
        self._said = -1.0

    def run(self, until: float, messages: Iterator[tuple[float, bytes]], true_place) -> None:
        """`true_place` is where the sender is, in s from the hour."""
        pending = next(messages, None)
        while self.now < until:
            self.now = round(self.now / PERIOD + 1) * PERIOD
            while pending is not None and pending[0] <= self.now:
                time, data = pending
                self.tracker.hear(time)
                if (found := self.decoder.take(data, time)) is not None:
                    self.tracker.take(found, time)
                pending = next(messages, None)
            self.tracker.look(self.now)
            if self.tracker.why and (not self.faults or self.faults[-1][1] != self.tracker.why):
                self.faults.append((self.now, self.tracker.why))
                if self.told:
                    self.follower.pause(self.source, self.now)
            if self.now - self._said >= SAID and (reference := self.tracker.reference(self.now)) is not None:
                self._said = self.now
                self.follower.follow(reference, False, self.now)
            self._tick(true_place(self.now))

    def _tick(self, code: float) -> None:
        self.follower.step(self.source, self.now)
        demand, _ = self.source.read(self.now, Feedback(self._motion, {}))
        for axis, setpoint in demand.items():
            assert isinstance(setpoint, StateTarget)
            self._motion[axis] = State(*setpoint)
        plays = self.source.phase is SequencePhase.PLAYING
        place = self.source.playback.time(self.now) if plays else None
        self.points.append(Point(self.now, code, place, dict(self._motion)))

    @property
    def rests(self) -> bool:
        return all(not state.velocity for state in self._motion.values())
