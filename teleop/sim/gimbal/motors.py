"""How a simulated motor moves: a plan made when a command arrives, evaluated afterwards at any moment.

A plan is a short run of segments, each a closed form of time: a commanded velocity, reached through a first-order lag.
Constant speed, holding still and coasting to rest are the same form with nothing lagging. Stops, expiries and ends of
travel are found when the plan is made. So reading a motor changes nothing, no error accumulates however often it is
read, and six hours of rest cost as much as none. During a dead time a plan also has what earlier commands still make
of the motor, and for late reports what is past.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import NamedTuple

from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.segment import SETTLED, Play, Segment, Swing


class _State(NamedTuple):
    """Position and velocity of the drive and of the shaft, and the position of the load."""

    drive: float
    drive_velocity: float
    shaft: float
    shaft_velocity: float
    load: float


class Motor:
    """One motor between two stops, in any unit; times are seconds of one clock and never go back.

    `lag` is the time constant of its velocity in s, `minimum` and `maximum` the stops, infinite for none. A motor that
    is beyond a stop, because the stop was moved, can only move back. One that is `held` stands still and
    drops every command. Its `dynamics` may change at any time: what was commanded before keeps the old ones.
    """

    def __init__(self, position: float, lag: float, minimum: float = -math.inf, maximum: float = math.inf) -> None:
        self.minimum, self.maximum = minimum, maximum
        self.held = False
        self.dynamics = Dynamics(lag=lag)
        self._plan: list[Segment] = [Segment(-math.inf, position)]

    def at(self, time: float) -> tuple[float, float]:
        """Position and velocity, at a time not before the last command by more than the age of a report."""
        time = max(time, self._plan[0].start)  # the age of reports has grown: the oldest that is known
        return self._segment(time).at(time)

    def cruise(self, now: float, velocity: float, until: float) -> None:
        """Follow `velocity` through the lag up to the time `until`, then coast to rest; against a stop, stand still."""
        if self.held:
            return
        start, end = now + self.dynamics.dead_time, until + self.dynamics.dead_time
        reached = self.dynamics.gain * velocity + self.dynamics.drift
        stages = [(end, reached), (math.inf, 0.0)] if end > start else [(math.inf, 0.0)]
        self._replace(now, start, self._following(start, stages))

    def coast(self, now: float) -> None:
        """Come to rest through the lag."""
        self.cruise(now, 0.0, now)

    def halt(self, now: float) -> None:
        """Stand still at once."""
        state = self._state(now)
        self._replace(now, now, [Segment(now, state.shaft, play=self._play(state.load))])

    def hold(self, now: float, held: bool) -> None:
        """A hand holds it at once, or releases it."""
        self.held = held
        self.halt(now)

    def place(self, position: float) -> None:
        """It is there, at rest, and always was."""
        self._plan = [Segment(-math.inf, position)]

    def travel(self, now: float, target: float, duration: float) -> None:
        """Go to `target`, or the stop before it, at constant speed in `duration` > 0 s."""
        self.visit(now, [(target, duration)])

    def visit(self, now: float, stations: Iterable[tuple[float, float]]) -> None:
        """Travel to each target in turn, each in its own duration in s."""
        if not self.held:
            start = now + self.dynamics.dead_time
            self._replace(now, start, self._visiting(start, stations))

    def ease(self, now: float, target: float, lag: float) -> None:
        """Go to `target` or the stop before it, fast at first and slower with the time constant `lag` in s."""
        if self.held:
            return
        start = now + self.dynamics.dead_time
        state, reached, end = self._state(start), self.clamp(target), start + SETTLED * lag
        approach = self._walled(self._segment_from(start, state, 0.0, (reached - state.drive) / lag, lag), end)
        arrived = _state_of(approach[-1], end)._replace(drive=reached)
        self._replace(now, start, [*approach, *self._walled(self._segment_from(end, arrived), math.inf)])

    def clamp(self, target: float) -> float:
        """The nearest position between the stops."""
        return min(max(target, self.minimum), self.maximum)

    def _segment(self, time: float) -> Segment:
        return next(segment for segment in reversed(self._plan) if segment.start <= time)

    def _replace(self, now: float, start: float, segments: Iterable[Segment]) -> None:
        """Plan `segments` from `start` on; keep what was planned before that, as far as it is still to be seen."""
        since, before = now - self.dynamics.report_age, [each for each in self._plan if each.start < start]
        kept = [each for each, after in pairwise([*before, Segment(start, 0.0)]) if after.start > since]
        self._plan = [*kept, *segments]

    def _state(self, time: float) -> _State:
        """As the plan has it, for the present dynamics: what these do not have any more leaves no jump."""
        state = _state_of(self._segment(time), time)
        if not self.dynamics.natural_frequency:
            state = state._replace(drive=state.shaft, drive_velocity=state.shaft_velocity)
        if not self.dynamics.backlash:
            gap = state.load - state.shaft
            state = state._replace(drive=state.drive + gap, shaft=state.load)
        return state

    def _segment_from(
        self, start: float, state: _State, target: float = 0.0, excess: float = 0.0, lag: float = 1.0
    ) -> Segment:
        swing, dynamics = None, self.dynamics
        if dynamics.natural_frequency:
            swing = Swing(dynamics.angular_frequency, dynamics.damping, state.shaft, state.shaft_velocity)
        return Segment(start, state.drive, target, excess, lag, swing, self._play(state.load))

    def _play(self, load: float) -> Play | None:
        return Play(self.dynamics.backlash / 2, load) if self.dynamics.backlash else None

    def _following(self, time: float, stages: Iterable[tuple[float, float]]) -> Iterator[Segment]:
        """The segments from `time` on through the stages (end in s, velocity), at rest where a stop is in the way."""
        state, lag = self._state(time), self.dynamics.lag
        low, high = self._room(state.shaft)
        for end, velocity in stages:
            while time < end:
                excess = state.drive_velocity - velocity if lag else 0.0
                segment = self._segment_from(time, state, velocity, excess, lag or 1.0)
                yield segment
                hit = segment.first_beyond(low, high, end)
                if hit is None:
                    time = end
                    if math.isfinite(end):
                        state = _state_of(segment, end)
                    break
                time, stop, direction = hit
                state = _State(stop, 0.0, stop, 0.0, segment.load(time))
                if velocity * direction >= 0.0:  # pushed on against the stop, or no more pushed at all
                    yield Segment(time, stop, play=self._play(state.load))
                    time = end

    def _visiting(self, time: float, stations: Iterable[tuple[float, float]]) -> Iterator[Segment]:
        state, lag = self._state(time), self.dynamics.position_lag
        aim = self.clamp(state.drive + lag * state.drive_velocity) if lag else state.drive  # what the drive lags behind
        for target, duration in stations:
            reached = self.clamp(target)
            slope = (reached - aim) / duration
            walled = self._walled(self._lagging(time, state, aim, slope), time + duration)
            yield from walled
            time, aim = time + duration, reached
            state = _state_of(walled[-1], time)
            state = state if lag else state._replace(drive=reached)
        yield from self._walled(self._lagging(time, state, aim, 0.0), math.inf)

    def _lagging(self, time: float, state: _State, aim: float, slope: float) -> Segment:
        """Follow what is at `aim` now and has the velocity `slope`, through the lag of positions."""
        lag = self.dynamics.position_lag
        excess = (aim - state.drive) / lag - slope if lag else 0.0
        return self._segment_from(time, state, slope, excess, lag or 1.0)

    def _walled(self, segment: Segment, end: float) -> list[Segment]:
        """The segment up to `end`, and what follows wherever the swing takes it to a stop; the drive stays inside."""
        segments = [segment]
        if segment.swing:
            low, high = self._room(segment.swing.position)
            while hit := segments[-1].first_beyond(low, high, end):
                segments.append(segments[-1].stopped(*hit[:2]))
        return segments

    def _room(self, position: float) -> tuple[float, float]:
        return min(self.minimum, position), max(self.maximum, position)


def _state_of(segment: Segment, time: float) -> _State:
    return _State(*segment.drive(time), *segment.shaft(time), segment.load(time))
