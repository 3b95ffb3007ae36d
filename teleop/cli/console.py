"""`teleop console`: a rig in the hands of a browser."""

from __future__ import annotations

from collections.abc import Sequence
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
from teleop.cli.signals import CODE, signals_to
from teleop.config.profile import Profile
from teleop.console import DEFAULT_BIND
from teleop.core.clock import SystemClock
from teleop.core.run_state import Result
from teleop.remote.remote_hands import RemoteHands


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
    output: Annotated[
        Path | None,
        Parameter(
            name=("--output", "-o"),
            metavar="FILE",
            help="Profile that a commissioning from the page writes, instead of the rig's own file.",
        ),
    ] = None,
    options: Options = DEFAULTS,
) -> int:
    """Move a rig from a browser, by touch, keys and moves; no terminal is needed, and Ctrl-C ends it.

    A commissioning is started from the Live page. The rig is at rest meanwhile; afterwards take control again.
    """
    profile = options.profile()
    refuse_offsets(profile)
    note = ""
    with reached.gateway(bind, options, profile) as gateway, realtime(in_real_time, complain):
        while True:
            hands = RemoteHands(reached.moves, gateway, [] if take else _devices(profile), note)
            run = LiveRun(
                profile, profile.name, SystemClock(), None, presets=presets, targets=targets, take=take, beside=hands
            )
            report = run.by_hand(_view, signals_to)
            if report.result is not Result.DONE or not hands.commissioned:
                return print_report(report, options.json)
            from teleop.cli.console_commission import commission_between, planning_for

            found = commission_between(hands.commissioned, options, output, gateway)
            if found.interrupted:
                return CODE
            options, note = found.options, found.line
            profile = options.profile()
            gateway = planning_for(gateway, profile)


def _devices(profile: Profile) -> Sequence[str]:
    """What can be commissioned of a rig."""
    has_gimbal = any(section.type == "gimbal" for section in profile.sinks)
    return [*(["gimbal"] if has_gimbal else []), *(["drone"] if profile.drones else [])]


def _view(parts: LiveParts) -> ConsoleView:
    return ConsoleView(lambda: parts.operator.status)
