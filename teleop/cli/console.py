"""`teleop console`: a rig in the hands of a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.drone_flight import refuse_offsets
from teleop.app.live import LiveParts, LiveRun
from teleop.app.realtime import realtime
from teleop.cli.console_options import NO_CONSOLE, ConsoleOptions, Realtime
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Take
from teleop.cli.running import print_report
from teleop.cli.screens.console_view import ConsoleView
from teleop.cli.screens.folded import complain
from teleop.cli.signals import signals_to
from teleop.console import DEFAULT_BIND
from teleop.core.clock import SystemClock


def console(
    *,
    bind: Annotated[
        str, Parameter(metavar="HOST:PORT", help="Where the console listens; port 0 picks one.")
    ] = DEFAULT_BIND,
    reached: ConsoleOptions = NO_CONSOLE,
    presets: Annotated[
        Path | None, Parameter(metavar="FILE", help="File of the presets; without it, one for each rig.")
    ] = None,
    targets: Annotated[
        Path | None, Parameter(metavar="FILE", help="Sequence file for the targets that key t marks; may be new.")
    ] = None,
    take: Take = None,
    in_real_time: Realtime = False,
    options: Options = DEFAULTS,
) -> int:
    """Move a rig from a browser, by touch, keys and moves; no terminal is needed, and Ctrl-C ends it."""
    from teleop.remote.remote_hands import RemoteHands

    profile = options.profile()
    refuse_offsets(profile)

    def view(parts: LiveParts) -> ConsoleView:
        return ConsoleView(lambda: parts.operator.status)

    with reached.gateway(bind, options, profile) as gateway, realtime(in_real_time, complain):
        hands = RemoteHands(reached.moves, gateway)
        run = LiveRun(
            profile, profile.name, SystemClock(), None, presets=presets, targets=targets, take=take, beside=hands
        )
        return print_report(run.by_hand(view, signals_to), options.json)
