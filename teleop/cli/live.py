"""`teleop live`: a rig in an operator's hands, or moved by recorded sticks.

Recorded sticks alone need neither a joystick nor a terminal: then only the STOP of what is plugged in counts.
Everything else goes through the `Operator`; what is recorded then drives the axes that no hand does.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.absent_devices import open_present
from teleop.cli.drone_run import Aboard, Understood, ask_to_fly, is_flown, refuse_offsets
from teleop.cli.key_terminal import key_terminal
from teleop.cli.open_inputs import open_devices
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Fast, Take, the_clock
from teleop.cli.running import commands, perform
from teleop.cli.screens.live_view import LiveView
from teleop.cli.screens.run_view import RunView, timed
from teleop.cli.screens.take_summary import take_words
from teleop.cli.stop_inputs import open_stop_inputs
from teleop.config.presets import default_file, read_presets
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.errors import UsageError
from teleop.core.events import Action
from teleop.core.interfaces import Clock
from teleop.devices.camera_answers import CameraAnswers
from teleop.devices.rig import Rig, open_rig
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.recorded_sticks import Sticks, SticksSource, read_sticks
from teleop.inputs.stick_shaping import shape
from teleop.manual.operator import Operator
from teleop.manual.stop_guard import Relay, StopGuard
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.writer import recording

NOBODY = "live: there is no joystick, and no terminal for its keys: plug one in, run it on a terminal, or give --sticks"


def live(
    *,
    sticks: Annotated[
        Path | None, Parameter(metavar="FILE", help="CSV: time in s, and a deflection of -1..1 for each axis.")
    ] = None,
    presets: Annotated[
        Path | None, Parameter(metavar="FILE", help="Where presets are kept; else one file for each rig.")
    ] = None,
    learn: Annotated[bool, Parameter(help="Ask what each control is to do.", negative=(), show_default=False)] = False,
    fast: Fast = False,
    take: Take = None,
    i_understand: Understood = False,
    options: Options = DEFAULTS,
) -> int:
    """Move a rig by joystick, dial and keys, or by sticks replayed from a file, which ends after its last row."""
    profile = options.profile()
    if learn:
        return _learn(profile)
    refuse_offsets(profile)
    if sticks is None and fast:
        raise UsageError("--fast: a hand keeps its own time; only --sticks can be replayed fast")
    recorded = None if sticks is None else read_sticks(sticks, list(profile.axes))
    replay = None if recorded is None else _replay(profile, recorded)
    title = profile.name if sticks is None else sticks.name
    axes: Sequence[Axis] = list(profile.axes) if recorded is None else recorded.axes
    keyboard = None if fast else _keyboard()
    aboard = Aboard()
    if recorded is not None:
        profile = profile.in_use(axes, () if keyboard is None else [Action.RECORD])
    clock = the_clock(fast, profile)
    if replay and recorded and keyboard is None:
        ask_to_fly(title, axes, i_understand)
        tally = TrackingErrorMonitor(lambda: replay.begin)
        limits = {axis: profile.limits[axis] for axis in axes}
        shown = timed(lambda: replay.begin, recorded.times[-1], "replaying sticks")
        status = aboard.status if is_flown(axes) else None
        with ExitStack() as stack:
            devices = [] if fast else open_stop_inputs(stack, profile, clock)
            guard = StopGuard(replay, [Relay(each) for each in devices])
            display = RunView(
                title, limits, lambda now: guard.over(shown(now)), silent=options.json, command="teleop live"
            )
            guard.say = display.say
            recorder = stack.enter_context(recording(take, profile.name, title, limits, status, patient=fast))
            rig = stack.enter_context(open_rig(profile, clock))
            aboard.board(rig, axes, display.say, by_script=True)
            return perform(*(rig, axes, [guard], tally, display, options.json, recorder), stopped=lambda: guard.reason)
    with ExitStack() as stack:
        inputs, note = open_devices(stack, profile, clock, keyboard is not None, NOBODY)
        rig, axes, left_out = _opened(stack, profile, clock, None if recorded is None else axes)
        limits = {axis: profile.limits[axis] for axis in axes}
        shelf = read_presets(presets or default_file(profile.name), limits, profile.name)
        stack.callback(shelf.close)
        hands = [*inputs, *([] if keyboard is None else [keyboard])]
        operator = Operator(limits, hands, shelf, profile.sticks, profile.presets.recall, replay)
        for line in (*left_out, *([note] if note else [])):
            operator.say(line)
        recorder = stack.enter_context(
            recording(take, profile.name, title, limits, lambda: aboard.status(operator.status))
        )
        aboard.board(rig, axes, operator.say, by_script=False)
        view = LiveView(
            title,
            limits,
            lambda: operator.status,
            rig.connections,
            keyboard,
            take_words(recorder),
            options.json,
            aboard.state,
        )
        observers, sinks = commands(rig, axes, operator.say, operator.confirmed)
        observers += [
            CameraAnswers(rig.camera, operator.say, operator.camera_answered, lenient=replay is None),
            *([] if keyboard is None else [keyboard]),
        ]
        tally = TrackingErrorMonitor(lambda: operator.begin)
        return perform(
            *(rig, axes, [operator], tally, view, options.json, recorder, observers, sinks),
            stopped=lambda: operator.reason,
        )


def _opened(
    stack: ExitStack, profile: Profile, clock: Clock, axes: Sequence[Axis] | None
) -> tuple[Rig, Sequence[Axis], Sequence[str]]:
    """The rig, its axes, and what is to be said of those that are absent; recorded sticks need all of their `axes`."""
    if axes is None:
        return open_present(stack, profile, clock)
    return stack.enter_context(open_rig(profile, clock)), axes, ()


def _replay(profile: Profile, recorded: Sticks) -> SticksSource:
    """Recorded sticks, with the dead zone and expo of the profile where it has them."""
    shaping = profile.sticks

    def velocity(axis: Axis, deflection: float) -> float:
        share = shaping.speed * shape(deflection, shaping.dead_zone or 0.0, shaping.expo or 0.0)
        return share * profile.axes[axis].velocity

    return SticksSource(recorded, velocity)


def _keyboard() -> Keyboard | None:
    """The keys of the terminal that this was started on, if there is one."""
    descriptor = key_terminal()
    return None if descriptor is None else Keyboard(descriptor)


def _learn(profile: Profile) -> int:
    from teleop.cli.learn import learn

    return learn(list(profile.axes))
