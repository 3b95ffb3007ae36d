"""What stands beside a run without the run knowing it: hands and eyes that reach it from another process."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Protocol

from teleop.app.run import RunReport
from teleop.config.presets import Presets
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.errors import LinkError
from teleop.core.events import Action, DeviceCommand
from teleop.core.interfaces import Clock, Observer, Sink, Source
from teleop.core.operator_input import Input
from teleop.devices.drone.state import DroneState
from teleop.devices.rig import Rig
from teleop.manual.operator import Operator
from teleop.manual.stop_guard import StopGuard
from teleop.sequence.source import SequenceSource
from teleop.timelapse.progress import Progress


class BesideLive(Protocol):
    """Hands beside those at the rig, outranked by them: inputs, and what drives the axes beneath all inputs.

    They outlast a run of the rig that failed, where what they do goes on in another one.
    """

    @property
    def inputs(self) -> Sequence[Input]: ...

    @property
    def beneath(self) -> Source: ...

    def open(self, stack: ExitStack, profile: Profile, limits: Mapping[Axis, Limits]) -> None:
        """Once, before the first run, until the stack is left."""
        ...

    def goes_on(self, report: RunReport | LinkError) -> bool:
        """Whether what they do goes on in another run, after this one or this try to reach the rig."""
        ...

    def wait(self, now: float) -> bool:
        """Called again and again until that begins: whether it is still wanted."""
        ...

    def attach(self, stack: ExitStack, operator: Operator, presets: Presets, rig: Rig) -> tuple[Observer, Sink]: ...

    def line(self, text: str) -> None:
        """A line that a device or a link gives the operator."""
        ...

    def confirmed(self, command: DeviceCommand) -> None: ...

    def camera_answered(self, action: Action, done: bool) -> None: ...


@dataclass(frozen=True)
class Running:
    """A run that moves by itself, for those beside it; `guard` is None until it begins, `show` is its screen's.

    `drone` has what is known of the drone, None in a run without one.
    """

    title: str
    guard: Callable[[], StopGuard | None]
    show: Callable[[str], object]
    source: SequenceSource | None = None
    progress: Progress | None = None
    drone: Callable[[], DroneState | None] = lambda: None


class BesideRun(Protocol):
    """Hands beside a run that moves by itself: they stop it, pause it, and see it."""

    @property
    def inputs(self) -> Sequence[Input]: ...

    @property
    def poll(self) -> float:
        """How often it has to be looked at while nothing moves, in s."""
        ...

    def open(self, stack: ExitStack, profile: Profile, limits: Mapping[Axis, Limits], clock: Clock) -> None: ...

    def attach(self, stack: ExitStack, running: Running) -> Observer: ...

    def line(self, text: str) -> None:
        """A line for the operator."""
        ...


def heard(notify: Callable[[str], object], beside: BesideRun | None) -> Callable[[str], object]:
    """Lines for the operator are for those beside the run too."""
    return notify if beside is None else both(notify, beside.line)


def both(first: Callable[..., object], second: Callable[..., object]) -> Callable[..., object]:
    """Calls one after the other."""

    def call(*arguments: object) -> None:
        first(*arguments)
        second(*arguments)

    return call
