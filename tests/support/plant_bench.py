"""Whole runs on virtual time on a gimbal that nobody has measured: a stick into a soft limit, and a keyframed move."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from types import MappingProxyType
from typing import Any
from unittest import mock

import numpy as np
from fakes import ScriptedSource
from unknown_gimbal import UnknownGimbal

from teleop.app.planning import plan_content
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.events import Tick
from teleop.core.interfaces import Source
from teleop.core.response import Response
from teleop.core.setpoints import VelocityTarget
from teleop.devices import rig as rigs
from teleop.devices.rig import open_rig
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.dynamics import Dynamics

PAN: Mapping[str, Any] = {"min": -180, "max": 180, "velocity": 120, "acceleration": 240, "jerk": 1200}
KEYS = [{"at": "0s", "pan": 0}, {"at": "2s", "pan": 45}, {"at": "5s", "pan": 10}]


class TracedGimbal(SimulatedGimbal):
    """The program's own simulated gimbal; `path` has the exact pan (deg) whenever it was looked at."""

    def __init__(self, dynamics: Dynamics, boot: tuple[float, float, float], **more: Any) -> None:
        super().__init__(dynamics=dynamics, boot=boot, joystick_speed=(120.0, 120.0, 120.0), **more)
        self.path: list[tuple[float, float]] = []

    def advance(self, now: float) -> bytes:
        sent = super().advance(now)
        self.path.append((now, self.angles.yaw))
        return sent


Far = TracedGimbal | UnknownGimbal
MakeFar = Callable[..., Far]


@dataclass
class Ran:
    """What came of a run: `path` is the exact pan over time, `notes` what was said, `responses` what was identified."""

    gimbal: Far
    reasons: Sequence[str]
    responses: Mapping[Axis, Response]
    notes: list[str]
    begin: float = 0.0
    ticks: list[Tick] = field(default_factory=list)

    def at(self, time: float) -> float:
        times, places = np.array(self.gimbal.path).T
        return float(np.interp(time, times, places))

    @property
    def highest(self) -> float:
        return max(place for _, place in self.gimbal.path)

    @property
    def lowest(self) -> float:
        return min(place for _, place in self.gimbal.path)


def profile_of(mode: str = "speed", rate: int = 50, pan: Mapping[str, Any] = PAN, **sink: Any) -> Profile:
    return Profile.model_validate(
        {
            "name": "Unknown",
            "links": {"gimbal": "sim:"},
            "axes": {"pan": dict(pan)},
            "sinks": [{"type": "gimbal", "link": "gimbal", "mode": mode, "rate": rate, **sink}],
        }
    )


@contextmanager
def far_end(gimbal: Far) -> Iterator[None]:
    with mock.patch.object(rigs, "SimulatedGimbal", return_value=gimbal):
        yield


class Keeper:
    """An observer that keeps every tick."""

    def __init__(self, hook: Callable[[Tick], object]) -> None:
        self.ticks: list[Tick] = []
        self._hook = hook

    def observe(self, tick: Tick) -> None:
        self.ticks.append(tick)
        self._hook(tick)


def run(
    gimbal: Far,
    profile: Profile,
    sources: Sequence[Source],
    priors: Mapping[Axis, Response] = MappingProxyType({}),
    hook: Callable[[Tick], object] = lambda _tick: None,
) -> Ran:
    """`hook` is called with each tick."""
    clock, keeper, notes = VirtualClock(100.0), Keeper(hook), list[str]()
    with far_end(gimbal), open_rig(profile, clock, priors=priors) as rig:
        if isinstance(sources[0], SequenceSource):
            rig.foresee(sources[0].foreseen)
            sources[0].rest_needed = partial(rig.rest_needed, [Axis.PAN])
        loop = rig.loop([Axis.PAN], sources, [keeper, rig.notes(notes.append)])
        ended = loop.run()
        return Ran(gimbal, ended.reasons, rig.responses, notes, ticks=keeper.ticks)


def stick(speed: float, seconds: float, after: float = 1.5) -> ScriptedSource:
    """A stick that is held for so long, and let go."""
    return ScriptedSource(lambda t: {Axis.PAN: VelocityTarget(speed if t < seconds else 0.0)}, seconds + after)


def into_limit(
    dynamics: Dynamics,
    profile: Profile,
    start: float = 0.0,
    speed: float = 80.0,
    make: MakeFar = TracedGimbal,
    priors: Mapping[Axis, Response] = MappingProxyType({}),
    **far: Any,
) -> tuple[float, Ran]:
    """How far beyond the upper soft limit a stick that is held at `speed` takes it, in deg."""
    gimbal, limit = make(dynamics, (start, 0.0, 0.0), **far), profile.limits[Axis.PAN].maximum
    ran = run(gimbal, profile, [stick(speed, (limit - start) / speed + 2.0)], priors)
    return ran.highest - limit, ran


def keyed(
    dynamics: Dynamics,
    profile: Profile,
    start: float = -20.0,
    keys: Sequence[Mapping[str, Any]] = KEYS,
    make: MakeFar = TracedGimbal,
    priors: Mapping[Axis, Response] = MappingProxyType({}),
    **far: Any,
) -> tuple[float, Ran]:
    """How far from a key it is at the worst, in deg; it eases from `start` to the first one."""
    gimbal, plan = make(dynamics, (start, 0.0, 0.0), **far), plan_content({"keyframes": list(keys)}, profile)
    source = SequenceSource(plan.sequence, profile.limits, cycle=Cycle(plan.sequence.preroll))
    ran = run(gimbal, profile, [source], priors)
    ran.begin = source.begin
    return max(abs(ran.at(source.begin + key.at) - key.position) for key in plan.sequence.keys[Axis.PAN]), ran
