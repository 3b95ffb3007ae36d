"""`teleop live`: a rig in an operator's hands, or moved by recorded sticks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.app.beside import BesideLive
from teleop.app.drone_flight import refuse_offsets
from teleop.app.live import LiveParts, LiveRun
from teleop.app.realtime import realtime
from teleop.cli.console_options import NO_CONSOLE, Console, ConsoleOptions, Realtime
from teleop.cli.drone_run import Understood, ask_to_fly
from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Fast, Take, the_clock
from teleop.cli.running import print_report
from teleop.cli.screens.folded import complain, warn
from teleop.cli.screens.live_view import LiveView
from teleop.cli.screens.run_view import RunView, timed
from teleop.cli.screens.take_summary import take_words
from teleop.cli.signals import signals_to
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.errors import UsageError
from teleop.core.events import Action
from teleop.core.run_status import RunStatus
from teleop.inputs.hid.recording import Recording, read_recording
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.recorded_sticks import Sticks, SticksSource, read_sticks
from teleop.recording.writer import Recorder

if TYPE_CHECKING:
    from teleop.remote.gateway_child import Gateway


def live(
    *,
    sticks: Annotated[
        Path | None, Parameter(metavar="FILE", help="CSV: time in s, and a deflection of -1..1 for each axis.")
    ] = None,
    input_recording: Annotated[
        list[Path] | None,
        Parameter(
            metavar="FILE",
            consume_multiple=False,
            help="Device recorded by `teleop devices record`, as if it were plugged in; may be repeated.",
        ),
    ] = None,
    presets: Annotated[
        Path | None, Parameter(metavar="FILE", help="File of the presets; without it, one for each rig.")
    ] = None,
    targets: Annotated[
        Path | None, Parameter(metavar="FILE", help="Sequence file for the targets that key t marks; may be new.")
    ] = None,
    learn: Annotated[
        bool, Parameter(help="Ask for each control, try it, and write the profile.", negative=(), show_default=False)
    ] = False,
    output: Annotated[
        Path | None, Parameter(name=("-o", "--output"), metavar="FILE", help="With --learn: the profile to write.")
    ] = None,
    fast: Fast = False,
    take: Take = None,
    console: Console = None,
    reached: ConsoleOptions = NO_CONSOLE,
    in_real_time: Realtime = False,
    i_understand: Understood = False,
    options: Options = DEFAULTS,
) -> int:
    """Move a rig by joystick, dial and keys, or by sticks replayed from a file, which ends after its last row."""
    profile = options.profile()
    recordings = [read_recording(file, number) for number, file in enumerate(input_recording or [], 1)]
    if learn:
        _refuse_beside_learn(sticks=sticks, fast=fast, take=take, presets=presets, console=console)
        return _learn(profile, options, output, recordings)
    if output is not None:
        raise UsageError("-o: needs --learn")
    refuse_offsets(profile)
    if sticks is None and not input_recording and fast:
        raise UsageError("--fast: needs --sticks or --input-recording: an operator's inputs are in real time")
    recorded = None if sticks is None else read_sticks(sticks, list(profile.axes))
    title = profile.name if sticks is None else sticks.name
    keyboard = None if fast else _keyboard()
    alone = None if recordings else recorded
    if alone is not None:
        profile = profile.in_use(alone.axes, () if keyboard is None else [Action.RECORD])
    if console is not None and (recorded is not None or recordings):
        raise UsageError("--console: not together with --sticks or --input-recording, which move the rig by themselves")
    run = LiveRun(
        profile, title, the_clock(fast, profile), keyboard, recorded, recordings, presets, take, fast, targets
    )
    if alone is not None and keyboard is None:
        ask_to_fly(title, alone.axes, i_understand)
        return _unattended(run, alone, options)
    replaced = "--sticks" if recorded is not None else "--input-recording" if recordings else ""
    with reached.beside(console, options, profile, replaced) as gateway, realtime(in_real_time, complain):
        return _by_hand(run if gateway is None else replace(run, beside=_hands(reached.moves, gateway)), options)


def _hands(moves: Path, gateway: Gateway) -> BesideLive:
    from teleop.remote.remote_hands import RemoteHands

    return RemoteHands(moves, gateway)


def _by_hand(run: LiveRun, options: Options) -> int:
    def view(parts: LiveParts) -> LiveView:
        return LiveView(
            *(run.title, parts.limits, lambda: parts.operator.status, parts.connections, run.keyboard),
            *(take_words(parts.recorder), options.json, parts.drone),
        )

    return print_report(run.by_hand(view, signals_to), options.json)


def _unattended(run: LiveRun, recorded: Sticks, options: Options) -> int:
    def status(replay: SticksSource) -> Callable[[float], RunStatus]:
        return timed(lambda: replay.begin, recorded.times[-1], "replaying sticks")

    def view(
        limits: Mapping[Axis, Limits], status: Callable[[float], RunStatus], _recorder: Recorder | None
    ) -> RunView:
        return RunView(run.title, limits, status, silent=options.json, command="teleop live")

    return print_report(run.unattended(status, view, signals_to, warn), options.json)


def _keyboard() -> Keyboard | None:
    """The keys of the terminal that this was started on, if there is one."""
    descriptor = key_terminal()
    return None if descriptor is None else Keyboard(descriptor)


def _refuse_beside_learn(**options: object) -> None:
    """Raises UsageError for options that have no meaning there: it asks in real time, and moves nothing."""
    for name, value in options.items():
        if value:
            raise UsageError(f"--{name}: not together with --learn, which moves nothing and asks in real time")


def _learn(profile: Profile, options: Options, output: Path | None, recordings: Sequence[Recording]) -> int:
    from teleop.cli.learn import learn

    return learn(profile, options.rig, output, recordings, options.json)
