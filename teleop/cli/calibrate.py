"""`teleop calibrate`: what a profile has to know about a gimbal, measured on the gimbal itself.

The measuring run is a run like any other: through the same loop, within the axis's limits, stopped by the same faults
and signals. The profile's own delay and gains are left out meanwhile, because they would hide what is looked for.
"""

from __future__ import annotations

import json
from contextlib import ExitStack
from dataclasses import replace
from statistics import fmean, stdev
from typing import TYPE_CHECKING

from cyclopts import App

from teleop.app.calibration_move import CalibrationMove
from teleop.cli.calibrate_signs import signs
from teleop.cli.examples import examples
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Fast, the_clock
from teleop.cli.running import EXIT_CODES
from teleop.cli.screens.folded import complain, tell
from teleop.cli.screens.run_view import RunView
from teleop.cli.signals import signals_to
from teleop.cli.stop_inputs import guarded
from teleop.config.profile import Profile
from teleop.config.sinks_section import Angle, GainsSection, GimbalSection
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError, UsageError
from teleop.core.run_state import Result, RunStateMachine
from teleop.core.run_status import Hint
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import open_rig

if TYPE_CHECKING:
    from teleop.monitors.delay_estimate import Delay, Traces

REACH = 6.0  # deg: enough for a grid of 0.1 deg, and little enough to be made anywhere
SWINGS = 6  # the first and the last are eased in and out, the others are measured
FAITHFUL = 0.5, 1.5  # times as far as commanded: beyond these it does something else than it was told
NOISE = 0.5  # deg rms that no delay explains

HINTS = (Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end"))

app = App(
    name="calibrate",
    help="Measure the delay and the signs of a gimbal for its profile.",
    help_epilogue=examples("calibrate"),
)
app.command(signs, help_epilogue=examples("calibrate signs"))


@app.command(name="delay", help_epilogue=examples("calibrate delay"))
def delay(*, axis: Angle = "pan", fast: Fast = False, options: Options = DEFAULTS) -> int:
    """Measure how much later than commanded the gimbal moves, by a small slow test move, for `delay` in the profile.

    Parameters
    ----------
    axis
        The axis that is moved: six degrees to one side and back, six times.
    """
    moved = Axis(axis)
    profile, mode = _undelayed(options.profile().in_use([moved]), moved)
    clock = the_clock(fast, profile)
    swing = CalibrationMove(moved, profile.limits[moved], REACH, SWINGS)
    title = f"measuring the delay of {axis}, mode {mode}"
    from teleop.monitors.delay_estimate import Traces

    traces = Traces(moved)
    warnings: list[str] = []
    with ExitStack() as stack:
        guard, keys = guarded(stack, swing, profile, clock, fast)
        hints = HINTS if keys else ()
        display = RunView(
            title,
            {moved: profile.limits[moved]},
            lambda now: guard.over(replace(swing.status(now), hints=hints)),
            silent=options.json,
            command="teleop calibrate",
        )
        guard.say = display.say
        rig = stack.enter_context(open_rig(profile, clock))
        notes = LinkNotes(rig.connections.values(), warnings.append)
        loop = rig.loop([moved], [guard], [traces, guard, notes, *map(stack.enter_context, keys), display])
        with signals_to(loop.interrupt, loop.release_at_once, display.say), display:
            ended = loop.run()
    for warning in warnings:
        complain(warning)
    ended.reasons += [guard.reason] if guard.reason else []
    if ended.result is not Result.DONE:
        return _stopped(ended, options.json)
    delays = _delays(swing, traces)
    _say(axis, mode, delays, options.json)
    return 0


def _undelayed(profile: Profile, axis: Axis) -> tuple[Profile, str]:
    """The rig with nothing that makes up for lateness, and the mode of the gimbal; raises UsageError without one."""
    for index, section in enumerate(profile.sinks):
        if isinstance(section, GimbalSection) and axis in section.axes and axis in profile.axes:
            bare = section.model_copy(update={"delay": 0.0, "gains": GainsSection(proportional=0.0, integral=0.0)})
            sinks = [*profile.sinks[:index], bare, *profile.sinks[index + 1 :]]
            return profile.model_copy(update={"sinks": sinks}), section.mode
    raise UsageError(f"--axis {axis}: no gimbal of {profile.name} moves it")


def _delays(swing: CalibrationMove, traces: Traces) -> list[Delay]:
    """One for each swing but the first and the last. Raises DeviceError when the axis did something else altogether."""
    from teleop.monitors.delay_estimate import estimate

    begins = [swing.begin + number * swing.period for number in range(1, SWINGS - 1)]
    each = [estimate(traces.commanded, traces.measured, begin, begin + swing.period) for begin in begins]
    delays = [one for one in each if one is not None]
    if len(delays) < len(each):
        raise DeviceError(
            "the axis did not move, or sent too few readings:"
            " check that the gimbal is unlocked and awake, and measure again"
        )
    scale, rms = fmean(one.scale for one in delays), max(one.rms for one in delays)
    if not FAITHFUL[0] <= scale <= FAITHFUL[1] or rms > NOISE:
        raise DeviceError(
            f"the axis moved {scale:.2f} times the commanded distance, with an error of {rms:.2f} deg:"
            " check that this gimbal supports this mode"
        )
    return delays


def _say(axis: str, mode: str, delays: list[Delay], as_json: bool) -> None:
    seconds = [one.seconds for one in delays]
    late, spread, scale = fmean(seconds), stdev(seconds), fmean(one.scale for one in delays)
    written = max(0.0, round(late, 3))  # a gimbal that seems to be early is one that is on time
    if as_json:
        found = {"delay": written, "measured": round(late, 5), "spread": round(spread, 5), "scale": round(scale, 4)}
        print(json.dumps({"result": "done", "axis": axis, "mode": mode, **found, "swings": len(delays)}))
        return
    tell(
        f"{axis} moves {1000 * written:.1f} ms later than commanded in mode {mode}"
        f" (spread {1000 * spread:.1f} ms over {len(delays)} swings), {scale:.2f} times as far"
    )
    print("for the gimbal among the sinks of the profile:")
    print(f"    delay: {written:g}")


def _stopped(ended: RunStateMachine, as_json: bool) -> int:
    if as_json:
        print(json.dumps({"result": ended.result.name.lower(), "reasons": ended.reasons}))
    else:
        for reason in ended.reasons:
            complain(f"teleop: stopped: {reason}")
    return EXIT_CODES[ended.result]
