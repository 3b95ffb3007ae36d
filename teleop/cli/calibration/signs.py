"""`teleop calibrate signs`: which way a gimbal counts its positions, its speeds and the angles that it reports."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from teleop.app.calibration.measure_signs import SignsReport, measure_signs
from teleop.app.calibration.sign_probe import REACH
from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Fast, the_clock
from teleop.cli.running import stopped
from teleop.cli.screens.folded import complain, warn
from teleop.cli.signals import signals_to
from teleop.config.wiring import Angle
from teleop.core.axes import Axis
from teleop.core.run_state import Result

WAYS: Mapping[Axis, str] = {Axis.PAN: "right", Axis.TILT: "up", Axis.ROLL: "clockwise"}  # teleop.core.axes.Axis


def signs(*, axis: Angle | None = None, fast: Fast = False, options: Options = DEFAULTS) -> int:
    """Measure which way the gimbal counts positions, speeds and angles, by moves of half a degree, for its `signs`.

    Parameters
    ----------
    axis
        The axis to measure; without it, all of the gimbal's, one after the other.
    """
    profile = options.profile()

    def begun(axes: Sequence[Axis], keyed: bool) -> None:
        if not options.json:
            complain(f"measuring the signs of {', '.join(axes)}: {REACH:g} deg to one side and back")
            if keyed:
                complain("space STOP   p pause   q end")

    clock, terminal = the_clock(fast, profile), None if fast else key_terminal()
    report = measure_signs(profile, axis, clock, begun, signals_to, complain, warn, terminal, fast)
    if report.result is not Result.DONE:
        return stopped(report.result, report.reasons, options.json)
    _print(report, options.json)
    return 0


def _print(report: SignsReport, as_json: bool) -> None:
    found, settings = report.signs, report.settings
    if as_json:
        measured = {axis.value: {"position": each.position, "speed": each.speed} for axis, each in found.items()}
        print(json.dumps({"result": "done", "measured": measured, **settings}))
        return
    command = "joystick" if report.section.mode == "stick" else "speed"
    for axis, each in found.items():
        speeds = {1: "the same way as positions", -1: "the other way than positions", 0: "nowhere"}
        reports = "" if each.position == 1 else "reported angles count against positions; "
        print(f"{axis}: {reports}{command} commands go {speeds[each.position * each.speed]}")
    print("for the gimbal among the sinks of the profile:")
    for key, signs_of in settings.items():
        print(f"    {key}: {{{', '.join(f'{name}: {sign}' for name, sign in signs_of.items())}}}")
    ways = ", ".join(f"{axis} + is {WAYS[axis]}" for axis in found)
    print(f"{ways}: if an axis goes the wrong way, turn its sign in signs, then measure again")
