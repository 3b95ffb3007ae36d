"""Measures how much later than commanded a gimbal moves, by a small test move.

The measuring run is a run like any other: through the same loop, within the axis's limits, stopped by the same faults
and signals. The profile's own delay and gains are left out meanwhile, because they would hide what is looked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from statistics import fmean, stdev

from teleop.app.calibration.calibration_move import CalibrationMove
from teleop.app.run import Screen, Signals
from teleop.app.stop_inputs import guarded
from teleop.config.profile import Profile
from teleop.config.sinks_section import GainsSection, GimbalSection
from teleop.core.axes import Axis, Limits
from teleop.core.errors import DeviceError, UsageError
from teleop.core.interfaces import Clock
from teleop.core.run_state import Result
from teleop.core.run_status import RunStatus
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import open_rig
from teleop.monitors.delay_estimate import Delay, Traces, estimate

REACH = 6.0  # deg: enough for a grid of 0.1 deg, and little enough to be made anywhere
SWINGS = 6  # the first and the last are eased in and out, the others are measured
FAITHFUL = 0.5, 1.5  # times as far as commanded: beyond these it does not obey the mode
NOISE = 0.5  # deg rms that no delay explains

MakeScreen = Callable[[str, Limits, Callable[[float], RunStatus], bool], Screen]
"""Makes the screen of the run, from the mode, the axis's limits, the status, and whether there are keys."""


@dataclass(frozen=True)
class DelayReport:
    """How the run ended; where it is DONE the `delays`, one for each measured swing, in a gimbal's `mode`.

    `warnings` are what its links reported.
    """

    result: Result
    reasons: Sequence[str]
    mode: str
    delays: Sequence[Delay] = ()
    warnings: Sequence[str] = field(default=())

    @property
    def seconds(self) -> float:
        """How much later than commanded it moves, s."""
        return fmean(each.seconds for each in self.delays)

    @property
    def spread(self) -> float:
        """The standard deviation between swings, s."""
        return stdev(each.seconds for each in self.delays)

    @property
    def scale(self) -> float:
        """How far it moves, as a share of what was commanded."""
        return fmean(each.scale for each in self.delays)

    @property
    def setting(self) -> float:
        """For `delay` in the profile, s: a gimbal that seems to be early is one that is on time."""
        return max(0.0, round(self.seconds, 3))


def measure_delay(
    profile: Profile,
    axis: Axis,
    clock: Clock,
    make_screen: MakeScreen,
    signals: Signals,
    warn: Callable[[str], object],
    terminal: int | None,
    virtual: bool = False,
) -> DelayReport:
    """Move `axis` six degrees to one side and back, six times.

    Raises UsageError where no gimbal moves it; DeviceError when the axis does not follow.
    """
    profile, mode = _undelayed(profile.in_use([axis]), axis)
    swing, traces = CalibrationMove(axis, profile.limits[axis], REACH, SWINGS), Traces(axis)
    warnings: list[str] = []
    with ExitStack() as stack:
        guard, keys = guarded(stack, swing, profile, clock, terminal, virtual, warn)
        screen = make_screen(mode, profile.limits[axis], lambda now: guard.over(swing.status(now)), bool(keys))
        guard.notify = screen.notify
        rig = stack.enter_context(open_rig(profile, clock))
        notes = LinkNotes(rig.connections.values(), warnings.append)
        loop = rig.loop([axis], [guard], [traces, notes, *map(stack.enter_context, keys), screen])
        with signals(loop.interrupt, loop.release_at_once, screen.notify), screen:
            ended = loop.run()
    reasons = [*ended.reasons, *([guard.reason] if guard.reason else [])]
    if ended.result is not Result.DONE:
        return DelayReport(ended.result, reasons, mode, warnings=warnings)
    return DelayReport(ended.result, reasons, mode, _delays(swing, traces), warnings)


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
