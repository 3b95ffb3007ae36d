"""`teleop calibrate signs`: which way a gimbal counts its positions, its speeds and the angles that it reports.

Positions and reported angles nearly always agree, speeds not so often. Which way is right, up and clockwise is for the
operator's eyes: no reading can tell.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack

from teleop.app.sign_probe import REACH, SignProbe, Signs
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.play import Fast, the_clock
from teleop.cli.running import EXIT_CODES
from teleop.cli.screens.folded import complain
from teleop.cli.signals import signals_to
from teleop.cli.stop_inputs import guarded
from teleop.config.profile import Profile
from teleop.config.sinks_section import Angle, GimbalSection
from teleop.config.wiring import Wiring
from teleop.core.axes import Axis
from teleop.core.control_loop import ControlLoop
from teleop.core.errors import UsageError
from teleop.core.run_state import Result
from teleop.core.timing import LoopTiming
from teleop.devices.gimbal.position import Angles
from teleop.devices.rig import open_rig
from teleop.planner.live import Live

WAYS: Mapping[Axis, str] = {Axis.PAN: "right", Axis.TILT: "up", Axis.ROLL: "clockwise"}  # teleop.core.axes.Axis


def signs(*, axis: Angle | None = None, fast: Fast = False, options: Options = DEFAULTS) -> int:
    """Measure which way the gimbal counts positions, speeds and angles, by moves of half a degree, for its `signs`.

    Parameters
    ----------
    axis
        The axis to measure; without it, all of the gimbal's, one after the other.
    """
    profile = options.profile()
    section, axes = _measured(profile, axis)
    clock = the_clock(fast, profile)
    limits = {each: profile.limits[each] for each in axes}
    full = None if section.mode != "stick" else lambda each: section.full(each, profile.limits[each].velocity)
    with ExitStack() as stack:
        rig = stack.enter_context(open_rig(profile.in_use(axes), clock))
        connection = rig.connections[section.link]
        probe = SignProbe(connection, axes, section.wiring, limits, full)
        reporter = Angles(connection, Wiring(section.axes), section.legacy_angles)
        guard, keys = guarded(stack, probe, profile, clock, fast)
        guard.say = complain
        timing = LoopTiming()
        planner = Live(limits, timing.period)
        loop = ControlLoop(clock, planner, limits, [guard], [probe], [reporter], keys, timing)
        if not options.json:
            complain(f"measuring the signs of {', '.join(axes)}: {REACH:g} deg to one side and back")
            if keys:
                complain("space STOP   p pause   q end")
        for each in keys:
            stack.enter_context(each)
        with signals_to(loop.interrupt, loop.release_at_once, complain):
            ended = loop.run()
    ended.reasons += [guard.reason] if guard.reason else []
    if ended.result is Result.DONE:
        _tell(section, probe.signs, options.json)
    elif options.json:
        print(json.dumps({"result": ended.result.name.lower(), "reasons": ended.reasons}))
    else:
        for reason in ended.reasons:
            complain(f"teleop: stopped: {reason}")
    return EXIT_CODES[ended.result]


def _measured(profile: Profile, axis: str | None) -> tuple[GimbalSection, Sequence[Axis]]:
    """The gimbal, and which of its axes to measure. Raises UsageError."""
    for section in profile.sinks:
        if isinstance(section, GimbalSection):
            axes = [each for each in section.axes if each in profile.limits and axis in (None, each)]
            if axes:
                return section, [each for each in axes if each is not None]
    raise UsageError(
        f"--axis {axis}: no gimbal of {profile.name} moves it" if axis else f"{profile.name} has no gimbal"
    )


def _tell(section: GimbalSection, found: Mapping[Axis, Signs], as_json: bool) -> None:
    settings = _settings(section, found)
    if as_json:
        measured = {axis.value: {"position": each.position, "speed": each.speed} for axis, each in found.items()}
        print(json.dumps({"result": "done", "measured": measured, **settings}))
        return
    command = "joystick" if section.mode == "stick" else "speed"
    for axis, each in found.items():
        speeds = {1: "the same way as positions", -1: "the other way than positions", 0: "nowhere"}
        reports = "" if each.position == 1 else "reported angles count against positions; "
        print(f"{axis}: {reports}{command} commands go {speeds[each.position * each.speed]}")
    print("for the gimbal among the sinks of the profile:")
    for key, signs_of in settings.items():
        print(f"    {key}: {{{', '.join(f'{name}: {sign}' for name, sign in signs_of.items())}}}")
    ways = ", ".join(f"{axis} + is {WAYS[axis]}" for axis in found)
    print(f"{ways}: if an axis goes the wrong way, turn its sign in signs, then measure again")


def _settings(section: GimbalSection, found: Mapping[Axis, Signs]) -> Mapping[str, Mapping[str, int]]:
    """The settings that make speeds and reports agree with positions; `report_signs` only where they do not."""
    wiring = section.wiring
    positions = {**section.signs, **{axis.value: wiring.sign(axis) for axis in found}}
    reports = {axis.value: wiring.sign(axis) * each.position for axis, each in found.items()}
    speeds = {axis.value: reports[axis.value] * each.speed for axis, each in found.items() if each.speed}
    settings = {"signs": positions, "speed_signs": {**section.speed_signs, **speeds}}
    if section.report_signs or any(each.position < 0 for each in found.values()):
        settings["report_signs"] = {**section.report_signs, **reports}
    return {key: signs_of for key, signs_of in settings.items() if signs_of}
