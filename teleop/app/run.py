"""One run on an open rig: watched, recorded, ended by signals, and reported as a value."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from types import TracebackType
from typing import Protocol, Self

from teleop.app.kept_responses import KeptReport, KeptResponses
from teleop.app.switch_interval import short_switch_interval
from teleop.core.axes import Axis
from teleop.core.events import DeviceCommand
from teleop.core.interfaces import Observer, Sink, Source
from teleop.core.response import Response
from teleop.core.run_state import Result
from teleop.devices.drone.state import DroneState
from teleop.devices.gimbal.commands import CommandSink, Unheard
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import Rig
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.writer import Recorder

COLLECTING = (700, 10, 10)  # Python's own: the collector looks often and shortly, not seldom and for long
Signals = Callable[
    [Callable[[str], object], Callable[[], object], Callable[[str], object]], AbstractContextManager[None]
]
"""Has signals call the first (interrupt, with a reason) and the second (release at once); the third gets lines."""


class Screen(Observer, Protocol):
    """Shows a run while it is entered; `notify` adds a line."""

    def notify(self, text: str) -> None: ...

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


@dataclass(frozen=True)
class RunReport:
    """How a run ended. `tracking` has how well each axis followed; `links` counts by link; `take` what was recorded.

    `responses` are what was identified of the axes that are sent speeds, of those that moved enough for it; `kept` is
    what became of them. `faults` is what was raised in the run.
    """

    result: Result
    reasons: Sequence[str]
    tracking: TrackingErrorMonitor
    links: Mapping[str, Mapping[str, int]]
    drone: DroneState | None = None
    take: Recorder | None = None
    responses: Mapping[Axis, Response] = field(default_factory=dict)
    kept: KeptReport = field(default_factory=KeptReport)
    faults: Sequence[BaseException] = ()


def run(
    rig: Rig,
    axes: Sequence[Axis],
    sources: Sequence[Source],
    tracking: TrackingErrorMonitor,
    screen: Screen,
    signals: Signals,
    take: Recorder | None = None,
    observers: Sequence[Observer] = (),
    sinks: Sequence[Sink] = (),
    stopped: Callable[[], str] = lambda: "",
    kept: KeptResponses | None = None,
) -> RunReport:
    """Run the sources on the rig until they end, a device fails or a signal comes.

    `stopped` is asked at the end for a STOP that was not cleared, which then is among the reasons. `kept` learns from
    the run, and keeps what is sure by its end.
    """
    if kept is not None:
        kept.begin(rig, screen.notify)
        observers = [*observers, kept]
    watching = [tracking, *observers, rig.notes(screen.notify), *([] if take is None else [take]), screen]
    loop = rig.loop(axes, sources, watching, sinks)
    with undisturbed(), signals(loop.interrupt, loop.release_at_once, screen.notify), screen:
        ended = loop.run()
    ended.reasons += [reason] if (reason := stopped()) else []
    links = {name: dict(connection.counts) for name, connection in rig.connections.items()}
    if take is not None:
        take.finish(ended.result, ended.reasons, links)
    drone = rig.drone(axes)
    state = None if drone is None else drone.state(rig.clock.now())
    keeping = KeptReport() if kept is None else kept.finish()
    return RunReport(ended.result, ended.reasons, tracking, links, state, take, rig.responses, keeping, loop.faults)


def commands(
    rig: Rig,
    axes: Sequence[Axis],
    notify: Callable[[str], object],
    done: Callable[[DeviceCommand], object] = lambda _command: None,
) -> tuple[list[Observer], list[Sink]]:
    """The observers of the links, and the sink of a gimbal's own commands where the rig has one; `notify` is for both.

    `done` is called with each command that the gimbal has confirmed.
    """
    sinks = command_sinks(rig, notify, done)
    unheard = Unheard(gimbal=bool(sinks), drone=rig.drone(axes) is not None, notify=notify)
    return [unheard, LinkNotes(rig.connections.values(), notify)], sinks


def command_sinks(
    rig: Rig, notify: Callable[[str], object], done: Callable[[DeviceCommand], object] = lambda _command: None
) -> list[Sink]:
    """What sends a gimbal its own commands, such as a follow mode: one sink, or none in a rig without a gimbal."""
    links = [section.link for section in rig.profile.sinks if section.type == "gimbal"]
    return [CommandSink(rig.connections[link], notify, done) for link in links[:1]]


@contextmanager
def undisturbed() -> Iterator[None]:
    """Threads give way to the control thread soon, and the collector passes over what is loaded by now.

    Afterwards the process is as it was found, whatever was raised.
    """
    gc.collect()
    thresholds = gc.get_threshold()
    gc.set_threshold(*COLLECTING)
    thaw = gc.get_freeze_count() == 0  # what the caller has frozen stays frozen; a part cannot be unfrozen
    if thaw:
        gc.freeze()  # a collection of all that is loaded takes 20 ms, two ticks
    try:
        with short_switch_interval:
            yield
    finally:
        gc.set_threshold(*thresholds)
        if thaw:
            gc.unfreeze()
