"""What `play` and `live` share: a run that shows itself, stops at a signal, and is reported."""

from __future__ import annotations

import gc
import json
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Protocol

from teleop.cli.display import Display, error_table
from teleop.motion import Axis
from teleop.ports import Sink, Source
from teleop.rig import Rig
from teleop.sinks.commands import CommandSink, Unheard
from teleop.sinks.link_notes import LinkNotes
from teleop.sinks.recorder import Recorder
from teleop.sinks.take_format import plain
from teleop.sinks.tally import Tally
from teleop.supervisor import Result, Supervisor

if TYPE_CHECKING:
    from teleop.cli.live_view import LiveView

EXIT_CODES: Mapping[Result, int] = {Result.DONE: 0, Result.FAILED: 1, Result.INTERRUPTED: 130}
SWITCH_INTERVAL = 0.0005  # s: how long the display's thread may hold up the control thread
TRAFFIC = ("frames_out", "frames_in", "replies")  # of a connection's counts, those that are no trouble
STOPPING = ("SIGINT", "SIGTERM")
LEAVING = ("SIGHUP", "SIGQUIT")  # these stop it too, unless whoever started it had them ignored: nohup


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
    tally: Tally,
    display: Display | LiveView,
    as_json: bool,
    take: Recorder | None = None,
    watchers: Sequence[Sink] = (),
    extras: Sequence[Extra] = (),
) -> int:
    """Run the sources on the rig, show it, record it if asked to, print the report and `extras`; the exit code."""
    loop = rig.loop(axes, sources, [tally, *watchers, *([] if take is None else [take]), display])
    with undisturbed(loop.interrupt), display:
        ended = loop.run()
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
            print(f"teleop: stopped: {reason}", file=sys.stderr)
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
            print(f"{name}: {', '.join(f'{count} {word}' for word, count in troubles.items())}")


def print_take(take: Recorder | None) -> None:
    """What was recorded, if anything was to be, and what could not be."""
    if take is None:
        return
    print(take)
    if take.trouble:
        print(f"teleop: {take.trouble}", file=sys.stderr)


def commands(rig: Rig, axes: Sequence[Axis], say: Callable[[str], object]) -> list[Sink]:
    """What gives a gimbal its own commands, where the rig has one, and what watches the links; `say` is for both."""
    links = [section.link for section in rig.profile.sinks if section.type == "gimbal"]
    heard = [CommandSink(rig.connections[link], say) for link in links[:1]]
    unheard = Unheard(gimbal=bool(heard), drone=rig.drone(axes) is not None, say=say)
    return [*heard, unheard, LinkNotes(rig.connections.values(), say)]


@contextmanager
def undisturbed(interrupt: Callable[[str], object]) -> Iterator[None]:
    """For a run: nothing of this process holds it up for long, and a signal asks it to stop by `interrupt`."""
    sys.setswitchinterval(SWITCH_INTERVAL)
    gc.collect()
    gc.freeze()  # a collection of all that is loaded takes 20 ms, two ticks
    with signals_to(interrupt):
        yield
    gc.unfreeze()


@contextmanager
def signals_to(interrupt: Callable[[str], object]) -> Iterator[None]:
    """Ctrl-C and its kin call `interrupt` with their name, however often they are sent, and do nothing else.

    Afterwards a terminal that closes is ignored: what is left to do is a report, and a hang-up may come late or twice.
    """

    def stop(number: int, _frame: FrameType | None) -> None:
        interrupt(f"{signal.Signals(number).name} received")

    numbers = [*_known(STOPPING), *(number for number in _known(LEAVING) if signal.getsignal(number) != signal.SIG_IGN)]
    before = {number: signal.signal(number, stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, signal.SIG_IGN if number.name in LEAVING else handler)


def _known(names: Sequence[str]) -> Sequence[signal.Signals]:
    """Those of the signals that this system has."""
    return [signal.Signals[name] for name in names if name in signal.Signals.__members__]


def _troubles(counts: Mapping[str, int]) -> Mapping[str, int]:
    """Those of a connection's counts that should be 0."""
    return {word.replace("_", " "): count for word, count in counts.items() if count and word not in TRAFFIC}


def _report(ended: Supervisor, tally: Tally, rig: Rig) -> Mapping[str, object]:
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
