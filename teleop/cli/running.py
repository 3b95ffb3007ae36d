"""What `play` and `live` share: a run that shows itself, stops at a signal, and is reported."""

from __future__ import annotations

import gc
import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

from teleop.cli.screens.folded import complain, tell
from teleop.cli.screens.run_view import RunView, error_table
from teleop.cli.signals import signals_to
from teleop.core.axes import Axis
from teleop.core.events import DeviceCommand
from teleop.core.interfaces import Observer, Sink, Source
from teleop.core.run_state import Result, RunStateMachine
from teleop.devices.gimbal.commands import CommandSink, Unheard
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import Rig
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.format import plain
from teleop.recording.writer import Recorder

if TYPE_CHECKING:
    from teleop.cli.screens.live_view import LiveView

EXIT_CODES: Mapping[Result, int] = {Result.DONE: 0, Result.FAILED: 1, Result.INTERRUPTED: 130}
SWITCH_INTERVAL = 0.0005  # s: how long the display's thread may hold up the control thread
TRAFFIC = ("frames_out", "frames_in", "replies")  # of a connection's counts, those that are no trouble


class Extra(Protocol):
    """What a command has to say at the end of a run, beside how well the rig followed."""

    def facts(self) -> Iterable[tuple[str, object]]:
        """For the JSON report: names and values."""
        ...

    def print(self) -> None: ...


def perform(
    rig: Rig,
    axes: Sequence[Axis],
    sources: Sequence[Source],
    tally: TrackingErrorMonitor,
    display: RunView | LiveView,
    as_json: bool,
    take: Recorder | None = None,
    observers: Sequence[Observer] = (),
    sinks: Sequence[Sink] = (),
    extras: Sequence[Extra] = (),
    stopped: Callable[[], str] = lambda: "",
) -> int:
    """Run the sources on the rig, show it, record it if asked to, print the report and `extras`; the exit code.

    `stopped` is asked at the end for a STOP that was not left, which then is among the reasons.
    """
    watching = [tally, *observers, *([] if take is None else [take]), display]
    loop = rig.loop(axes, sources, watching, sinks)
    with undisturbed(loop.interrupt, loop.release_at_once, display.say), display:
        ended = loop.run()
    ended.reasons += [reason] if (reason := stopped()) else []
    if take is not None:
        links = {name: dict(connection.counts) for name, connection in rig.connections.items()}
        take.finish(ended.result, ended.reasons, links)
    if as_json:
        report = {**_report(ended, tally, rig), **{name: value for extra in extras for name, value in extra.facts()}}
        if drone := rig.drone(axes):
            report = {**report, "drone": plain(drone.state(rig.clock.now()))}
        print(json.dumps(report if take is None else {**report, "take": take.facts}))
    else:
        for reason in ended.reasons:
            complain(f"teleop: stopped: {reason}")
        if tally.scores:
            error_table(tally)
        for extra in extras:
            extra.print()
        print_links({name: connection.counts for name, connection in rig.connections.items()})
        print_take(take)
    return EXIT_CODES[ended.result]


def print_links(links: Mapping[str, Mapping[str, int]]) -> None:
    """What went wrong on each link without ending the run."""
    for name, counts in links.items():
        if troubles := _troubles(counts):
            tell(f"{name}: {', '.join(f'{count} {word}' for word, count in troubles.items())}")


def print_take(take: Recorder | None) -> None:
    """What was recorded, if anything was to be, and what could not be."""
    if take is None:
        return
    tell(str(take))
    if take.trouble:
        complain(f"teleop: {take.trouble}")


def commands(
    rig: Rig,
    axes: Sequence[Axis],
    say: Callable[[str], object],
    done: Callable[[DeviceCommand], object] = lambda _command: None,
) -> tuple[list[Observer], list[Sink]]:
    """The sink of a gimbal's own commands, where the rig has one, and the observers of the links; `say` is for both.

    `done` is called with each command that the gimbal has confirmed.
    """
    links = [section.link for section in rig.profile.sinks if section.type == "gimbal"]
    heard = [CommandSink(rig.connections[link], say, done) for link in links[:1]]
    unheard = Unheard(gimbal=bool(heard), drone=rig.drone(axes) is not None, say=say)
    return [unheard, LinkNotes(rig.connections.values(), say)], [*heard]


@contextmanager
def undisturbed(
    interrupt: Callable[[str], object], release: Callable[[], object], say: Callable[[str], object]
) -> Iterator[None]:
    """For a run: nothing of this process holds it up for long, and signals end it, see `signals_to`.

    Afterwards the process is as it was found, whatever was raised.
    """
    with unhurried(), signals_to(interrupt, release, say):
        yield


@contextmanager
def unhurried() -> Iterator[None]:
    """Threads give way to the control thread soon, and the collector passes over what is loaded by now."""
    interval = sys.getswitchinterval()
    gc.collect()
    thaw = gc.get_freeze_count() == 0  # what somebody else has frozen stays so, and there is no thawing a part
    if thaw:
        gc.freeze()  # a collection of all that is loaded takes 20 ms, two ticks
    sys.setswitchinterval(SWITCH_INTERVAL)
    try:
        yield
    finally:
        sys.setswitchinterval(interval)
        if thaw:
            gc.unfreeze()


def _troubles(counts: Mapping[str, int]) -> Mapping[str, int]:
    """Those of a connection's counts that should be 0."""
    return {word.replace("_", " "): count for word, count in counts.items() if count and word not in TRAFFIC}


def _report(ended: RunStateMachine, tally: TrackingErrorMonitor, rig: Rig) -> Mapping[str, object]:
    return {
        "result": ended.result.name.lower(),
        "reasons": ended.reasons,
        "seconds": round(tally.seconds, 3),
        "axes": {
            axis.value: {"readings": score.readings, "rms": round(score.rms, 6), "peak": round(score.peak, 6)}
            for axis, score in tally.scores.items()
        },
        "links": {name: connection.counts for name, connection in rig.connections.items()},
    }
