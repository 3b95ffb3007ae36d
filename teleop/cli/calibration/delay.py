"""`teleop calibrate`: what a profile has to know about a gimbal, measured on the gimbal itself."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

from cyclopts import App

from teleop.app.calibration.measure_delay import DelayReport, measure_delay
from teleop.cli.calibration.response import response
from teleop.cli.calibration.signs import signs
from teleop.cli.examples import examples
from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Fast, the_clock
from teleop.cli.running import stopped
from teleop.cli.screens.folded import complain, tell, warn
from teleop.cli.screens.run_view import RunView
from teleop.cli.signals import signals_to
from teleop.config.wiring import Angle
from teleop.core.axes import Axis, Limits
from teleop.core.run_state import Result
from teleop.core.run_status import Hint, RunStatus

HINTS = (Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end"))

app = App(
    name="calibrate",
    help="Measure how the axes of a gimbal answer, or its delay, or its signs.",
    help_epilogue=examples("calibrate"),
)
app.default(response)
app.command(response, name="response", help_epilogue=examples("calibrate response"))
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
    profile = options.profile()

    def view(mode: str, limits: Limits, status: Callable[[float], RunStatus], keyed: bool) -> RunView:
        title, hints = f"measuring the delay of {axis}, mode {mode}", HINTS if keyed else ()
        return RunView(
            title,
            {moved: limits},
            lambda now: replace(status(now), hints=hints),
            silent=options.json,
            command="teleop calibrate",
        )

    clock, terminal = the_clock(fast, profile.in_use([moved])), None if fast else key_terminal()
    report = measure_delay(profile, moved, clock, view, signals_to, warn, terminal, fast)
    for warning in report.warnings:
        complain(warning)
    if report.result is not Result.DONE:
        return stopped(report.result, report.reasons, options.json)
    _print(axis, report, options.json)
    return 0


def _print(axis: str, report: DelayReport, as_json: bool) -> None:
    late, spread, scale, swings = report.seconds, report.spread, report.scale, len(report.delays)
    if as_json:
        found = {
            "delay": report.setting,
            "measured": round(late, 5),
            "spread": round(spread, 5),
            "scale": round(scale, 4),
        }
        print(json.dumps({"result": "done", "axis": axis, "mode": report.mode, **found, "swings": swings}))
        return
    tell(
        f"{axis} moves {1000 * report.setting:.1f} ms later than commanded in mode {report.mode}"
        f" (spread {1000 * spread:.1f} ms over {swings} swings), {scale:.2f} times as far"
    )
    print("for the gimbal among the sinks of the profile:")
    print(f"    delay: {report.setting:g}")
