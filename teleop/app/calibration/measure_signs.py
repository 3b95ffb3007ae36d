"""Measures which way a gimbal counts its positions, its speeds and the angles that it reports, by small moves.

Positions and reported angles nearly always agree, speeds often do not. Which way is right, up and clockwise is for the
operator's eyes: no reading can tell.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

from teleop.app.calibration.measured_axes import measured_axes
from teleop.app.calibration.sign_probe import SignProbe, Signs
from teleop.app.run import Signals
from teleop.app.stop_inputs import guarded
from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import Wiring
from teleop.core.axes import Axis
from teleop.core.control_loop import ControlLoop
from teleop.core.interfaces import Clock
from teleop.core.run_state import Result
from teleop.core.timing import LoopTiming
from teleop.devices.gimbal.position import Angles
from teleop.devices.rig import open_rig
from teleop.planner.live import Live


@dataclass(frozen=True)
class SignsReport:
    """How the run ended; where it is DONE the `signs` of each axis, and the `settings` for the profile."""

    result: Result
    reasons: Sequence[str]
    section: GimbalSection
    signs: Mapping[Axis, Signs]

    @property
    def settings(self) -> Mapping[str, Mapping[str, int]]:
        return _settings(self.section, self.signs)


def measure_signs(
    profile: Profile,
    axis: str | None,
    clock: Clock,
    begun: Callable[[Sequence[Axis], bool], object],
    signals: Signals,
    notify: Callable[[str], object],
    warn: Callable[[str], object],
    terminal: int | None,
    virtual: bool = False,
) -> SignsReport:
    """Move `axis`, or each of the gimbal's, half a degree to one side and back.

    `begun` is called with the axes and whether there are keys. Raises UsageError where no gimbal moves the axis.
    """
    section, axes = measured_axes(profile, axis)
    limits = {each: profile.limits[each] for each in axes}
    full = None if section.mode != "stick" else lambda each: section.full(each, profile.limits[each].velocity)
    with ExitStack() as stack:
        rig = stack.enter_context(open_rig(profile.in_use(axes), clock))
        probe = SignProbe(rig.connections[section.link], axes, section.wiring, limits, full)
        reporter = Angles(
            rig.connections[section.link], Wiring(section.axes, mount=section.mount.yaw), section.legacy_angles
        )
        guard, keys = guarded(stack, probe, profile, clock, terminal, virtual, warn)
        guard.notify = notify
        timing = LoopTiming()
        planner = Live(limits, timing.period)
        loop = ControlLoop(clock, planner, limits, [guard], [probe], [reporter], keys, timing)
        begun(axes, bool(keys))
        for each in keys:
            stack.enter_context(each)
        with signals(loop.interrupt, loop.release_at_once, notify):
            ended = loop.run()
    reasons = [*ended.reasons, *([guard.reason] if guard.reason else [])]
    return SignsReport(ended.result, reasons, section, probe.signs if ended.result is Result.DONE else {})


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
