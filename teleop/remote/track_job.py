"""An aim that follows what a tracker reports, for as long as it does: the planner meets it within the limits.

Far from it, the planner has its fastest rendezvous with a target that moves (Ruckig, in the frame that moves with it).
Near it, where the limits allow, the axis comes up to the target as a damped spring does: a tracker's noise would make
the fastest way tremble. A stream that is silent is a hand that is lost.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.errors import TeleopError
from teleop.core.events import SourceEvent, Tick
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand, Setpoint, StateTarget, Stop
from teleop.remote.aims import ENDED, AimStream
from teleop.remote.jobs import Ended

SWIFTNESS = 15.0  # 1/s: an axis has met its target to 2 % after 0.5 s
SHARE = 0.9  # of each limit: what needs more is the planner's rendezvous
BEYOND = 0.5  # deg past a soft limit, from which on it is told
BEHIND, BEHIND_FOR = 3.0, 1.0  # deg behind the target, for so long (s): it is too fast for the axis
BACK = 0.5  # deg from the target, at which it is reached again
SILENT = "nothing has arrived"


class TrackJob:
    """`source` is the number of the stream, `notify` takes lines for the operator."""

    def __init__(
        self,
        source: int,
        owner: str,
        stream: AimStream,
        limits: Mapping[Axis, Limits],
        attended: bool,
        notify: Callable[[str], object],
        ended: Ended,
    ) -> None:
        self.title, self.owner, self.attended, self.ended = "track", owner, attended, ended
        self.source, self._stream = source, stream
        self._notify = notify
        self._followed = {axis: _Followed(axis, limits[axis], notify) for axis in stream.axes}
        self._now = 0.0

    @property
    def axes(self) -> Collection[Axis]:
        return self._followed

    def trouble(self, now: float) -> str:
        """Why it is not on its target, "" when it is or is on its way."""
        if not self._stream.fresh(now):
            return "nothing arrives: it waits"
        return ", ".join(each.trouble for each in self._followed.values() if each.trouble)

    def start(self, now: float, motion: Motion) -> None:
        self._now = now
        for axis, followed in self._followed.items():
            followed.start(self._stream.at(axis, now).position, motion[axis])

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        seconds, self._now = now - self._now, now
        if not self._stream.fresh(now) or self._stream.axes != tuple(self._followed):
            return {axis: Stop() for axis in self._followed}, ()
        demand: dict[Axis, Setpoint] = {
            axis: followed.step(self._stream.at(axis, now), feedback.motion[axis], now, seconds)
            for axis, followed in self._followed.items()
        }
        return demand, ()

    def done(self, tick: Tick) -> bool:
        """Never by itself; raises TeleopError once the stream is over."""
        if self._stream.age(tick.time) > ENDED:
            why = f"{SILENT} from tracking source {self.source} for {ENDED:g} s: track again"
            self._notify(f"tracking ends: {why}")
            raise TeleopError(why)
        return False

    def halt(self, now: float, why: str) -> bool:  # noqa: ARG002 - it has to be asked for anew
        return True

    outranked = halt

    def foreseen(self, time: float) -> Motion:  # noqa: ARG002 - the target decides on its way
        return {}


class _Followed:
    """One axis, and what the operator was told of it."""

    def __init__(self, axis: Axis, limits: Limits, notify: Callable[[str], object]) -> None:
        self._axis, self._limits, self._notify = axis, limits, notify
        self._turns = 0.0
        self.trouble = ""
        self._behind_since: float | None = None
        self._met = False

    def start(self, target: float, state: State) -> None:
        """From `state`; of an angle the turn is taken that is within the limits, and the nearest of those."""
        if self._axis is Axis.PAN:
            nearest = round((state.position - target) / 360)
            turns = [360.0 * (nearest + each) for each in (0, 1, -1)]
            inside = [each for each in turns if self._limits.minimum <= target + each <= self._limits.maximum]
            self._turns = min(inside or turns[:1], key=lambda each: abs(target + each - state.position))

    def step(self, aim: State, state: State, now: float, seconds: float) -> StateTarget:
        """What `state` is to be a tick on, towards a target that moves."""
        target = aim.position + self._turns
        inside = min(max(target, self._limits.minimum), self._limits.maximum)
        self._tell(target, inside, state, now)
        bend = min(max(aim.acceleration, -self._limits.acceleration), self._limits.acceleration)
        goal = State(inside, aim.velocity, bend) if inside == target else State(inside)
        near = _towards(state, goal, seconds)
        return StateTarget(*(near if self._allows(state, near, seconds) else goal))

    def _allows(self, state: State, after: State, seconds: float) -> bool:
        of = self._limits
        return (
            abs(after.velocity) <= SHARE * of.velocity
            and abs(after.acceleration) <= SHARE * of.acceleration
            and abs(after.acceleration - state.acceleration) <= SHARE * of.jerk * seconds
        )

    def _tell(self, target: float, inside: float, state: State, now: float) -> None:
        beyond, behind = abs(target - inside), abs(inside - state.position)
        if behind < BACK and beyond < BEYOND:
            if self.trouble:
                self._notify(f"track: {self._axis} has its target again")
            self.trouble, self._behind_since, self._met = "", None, True
            return
        self._behind_since = self._behind_since if behind > BEHIND and self._behind_since is not None else now
        if self.trouble:
            return
        if beyond > BEYOND:
            self.trouble = f"{self._axis} waits at its soft limit"
            limit = f"the soft limit of {self._axis} ({inside:g})"
            self._notify(f"track: the target is {beyond:.1f} deg beyond {limit}: it waits there")
        elif self._met and behind > BEHIND and now - self._behind_since > BEHIND_FOR:
            self.trouble = f"{self._axis} is behind"
            self._notify(f"track: {self._axis} is {behind:.1f} deg behind its target, which is too fast for its limits")


def _towards(state: State, goal: State, seconds: float) -> State:
    """A critically damped way of the third order onto a goal, in closed form: `seconds` on, when `goal` is there."""
    before = goal.velocity - goal.acceleration * seconds
    error = state.position - (goal.position - (before + goal.velocity) / 2 * seconds)
    rate, bend = state.velocity - before, state.acceleration - goal.acceleration
    fade = math.exp(-SWIFTNESS * seconds)
    first = rate + SWIFTNESS * error
    second = (bend + 2 * SWIFTNESS * rate + SWIFTNESS**2 * error) / 2
    value = error + first * seconds + second * seconds**2
    slope = first + 2 * second * seconds
    return State(
        goal.position + fade * value,
        goal.velocity + fade * (slope - SWIFTNESS * value),
        goal.acceleration + fade * (2 * second - 2 * SWIFTNESS * slope + SWIFTNESS**2 * value),
    )
