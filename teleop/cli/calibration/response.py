"""`teleop calibrate`, or `teleop calibrate response`: how each axis of a gimbal answers, for later runs."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.calibration.measure_response import (
    REACH,
    SWINGS,
    ResponseReport,
    keep,
    measure_responses,
    move_of,
)
from teleop.app.calibration.measured_axes import measured_axes
from teleop.cli.calibration.response_picture import check_picture, draw_picture
from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import DEFAULTS, Options, announce, announce_json
from teleop.cli.play import Fast, the_clock
from teleop.cli.running import stopped
from teleop.cli.screens.folded import complain, warn
from teleop.cli.screens.response_lines import response_facts
from teleop.cli.screens.run_view import RunView
from teleop.cli.signals import signals_to
from teleop.config.profile import Profile
from teleop.config.response_store import ResponseStore, default_folder
from teleop.config.wiring import Angle
from teleop.core.axes import Axis, Limits
from teleop.core.run_state import Result
from teleop.core.run_status import Hint, RunStatus

HINTS = (Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end"))


def response(
    *,
    axis: Angle | None = None,
    output: Annotated[
        Path | None,
        Parameter(name=("--output", "-o"), metavar="FILE", help="Draw it: a page (.html) or a drawing (.svg, .png)."),
    ] = None,
    dry_run: Annotated[
        bool, Parameter(help="Show what would move, and how far; move nothing.", negative=(), show_default=False)
    ] = False,
    fast: Fast = False,
    options: Options = DEFAULTS,
) -> int:
    """Measure how each axis of the gimbal answers: delay, gain and drift, each with its doubt, kept for later runs.

    Parameters
    ----------
    axis
        The axis to measure; without it, all of the gimbal's, one after the other.
    """
    profile, moved = options.profile(), None if axis is None else Axis(axis)
    if output is not None:
        check_picture(output)
    section, axes = measured_axes(profile, moved)
    if dry_run:
        return _dry_run(profile, section.mode, axes, options.json)
    store = ResponseStore(default_folder())

    def view(mode: str, axis: Axis, limits: Limits, status: Callable[[float], RunStatus], keyed: bool) -> RunView:
        title, hints = f"measuring how {axis} answers, mode {mode}", HINTS if keyed else ()
        shown = lambda now: replace(status(now), hints=hints)  # noqa: E731 - one of several arguments
        return RunView(title, {axis: limits}, shown, silent=options.json, command="teleop calibrate")

    clock, terminal = the_clock(fast, profile.in_use(axes)), None if fast else key_terminal()
    report = measure_responses(profile, moved, clock, view, signals_to, warn, terminal, fast)
    for warning in report.warnings:
        complain(warning)
    kept = keep(report, store)
    if store.damage:
        complain(f"teleop: warning: {store.damage}")
    if report.result is not Result.DONE or len(report.axes) < len(axes):
        return stopped(report.result, report.reasons, options.json)
    if output is not None:
        draw_picture(report, output)
    _print(report, kept, output, options.json)
    return 0


def _dry_run(profile: Profile, mode: str, axes: Sequence[Axis], as_json: bool) -> int:
    moves = {axis: move_of(profile, axis) for axis in axes}
    if as_json:
        planned = {
            axis.value: {"reach": REACH, "swings": SWINGS, "seconds": round(move.duration, 3)}
            for axis, move in moves.items()
        }
        print(json.dumps({"result": "dry run", "mode": mode, "axes": planned}))
        return 0
    for axis, move in moves.items():
        print(
            f"{axis} would move {REACH:g} deg to the side with more room and back, {SWINGS} times in"
            f" {move.duration:.0f} s, at most {move.fastest:.0f} deg/s, mode {mode}"
        )
    print("nothing was moved")
    return 0


def _print(report: ResponseReport, kept: Sequence[Axis], output: Path | None, as_json: bool) -> None:
    written = [] if output is None else [output]
    if as_json:
        axes = {
            each.axis.value: {**response_facts(each.response), "rms": round(each.rms, 4), "kept": each.axis in kept}
            for each in report.axes
        }
        key = report.key._asdict()
        announce_json({"result": "done", **key, "axes": axes, "delay": report.delay}, *written)
        return
    for each in report.axes:
        of = each.response
        announce(
            f"{each.axis} answers {of.delay:.3f} s late (doubt {of.delay_doubt:.3f}), gain {of.gain:.3f} (doubt"
            f" {of.gain_doubt:.3f}), drift {round(of.drift, 2) + 0.0:.2f} deg/s (doubt {of.drift_doubt:.2f});"
            f" {each.rms:.2f} deg rms unexplained{'; kept for the next run' if each.axis in kept else ''}",
            *written,
        )
    anew = "" if report.key.mode == "position" else "each run finds it anew, unless the profile has it: "
    announce(f"{anew}for the gimbal among the sinks of the profile:", *written)
    announce(f"    delay: {report.delay:g}", *written)
