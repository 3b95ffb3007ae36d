"""Measures how each axis of a gimbal answers, by a small test move of each in turn, with the estimator of every run.

A measuring run is a run like any other: through the same loop, within the axis's limits, stopped by the same faults and
signals. It begins without a prior and without the profile's delay, so that nothing but the readings counts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

import numpy as np

from teleop.app.calibration.calibration_move import CalibrationMove
from teleop.app.calibration.measured_axes import measured_axes
from teleop.app.run import Screen, Signals
from teleop.app.stop_inputs import guarded
from teleop.config.profile import Profile
from teleop.config.response_store import Key, ResponseStore
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis, Limits, Reading
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.core.interfaces import Clock
from teleop.core.response import Response
from teleop.core.run_state import Result
from teleop.core.run_status import RunStatus
from teleop.devices.gimbal.speed_control import SpeedControl
from teleop.devices.gimbal.stick import SETTING
from teleop.devices.gimbal.version import VersionQuestion
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import Rig, open_rig
from teleop.identification.candidates import Start
from teleop.identification.estimator import ResponseEstimator
from teleop.identification.prediction import predicted
from teleop.identification.travel import Floats
from teleop.links.url import parse
from teleop.monitors.delay_estimate import estimate

REACH = 6.0  # deg: enough for a grid of 0.1 deg, and little enough to be made anywhere
SWINGS = 8
SECONDS = 2.0  # s for a swing, or longer where the axis's limits ask for it
MISFIT = 0.5  # deg rms that the response leaves

MakeScreen = Callable[[str, Axis, Limits, Callable[[float], RunStatus], bool], Screen]
"""Makes the screen of a run, from the mode, the axis and its limits, the status, and whether there are keys."""


@dataclass(frozen=True)
class AxisResponse:
    """What was measured of an axis: its response, and the readings with what the response explains of them (deg)."""

    axis: Axis
    response: Response
    readings: Sequence[Reading]
    model: Floats

    @property
    def rms(self) -> float:
        """What the response does not explain, in deg."""
        measured = np.array([each.position for each in self.readings])
        return float(np.sqrt(np.mean((measured - self.model) ** 2)))


@dataclass(frozen=True)
class ResponseReport:
    """How the last run ended; `axes` are those that were measured by then, of a gimbal with this `key`.

    `warnings` are what its links reported.
    """

    result: Result
    reasons: Sequence[str]
    key: Key
    axes: Sequence[AxisResponse] = ()
    warnings: Sequence[str] = ()

    @property
    def delay(self) -> float:
        """For `delay` in the profile, s: one for all axes."""
        delays = [each.response.delay for each in self.axes]
        return max(0.0, round(math.fsum(delays) / len(delays), 3))


def move_of(profile: Profile, axis: Axis) -> CalibrationMove:
    """What `axis` is going to do. Raises UsageError when its limits are too low for it."""
    return CalibrationMove(axis, profile.limits[axis], REACH, SWINGS, SECONDS)


def measure_responses(
    profile: Profile,
    axis: Axis | None,
    clock: Clock,
    make_screen: MakeScreen,
    signals: Signals,
    warn: Callable[[str], object],
    terminal: int | None,
    virtual: bool = False,
) -> ResponseReport:
    """Move `axis`, or each of the gimbal's in turn. Raises UsageError, and DeviceError when one does not follow."""
    section, axes = measured_axes(profile, axis)
    plain = section.model_copy(update={"delay": None})
    bare = profile.model_copy(update={"sinks": [plain if each is section else each for each in profile.sinks]})
    moves = {each: move_of(profile, each) for each in axes}
    key = Key(profile.name, "", parse(profile.links[section.link]).kind, section.mode, section.payload)
    found: list[AxisResponse] = []
    warnings: list[str] = []
    for each in axes:
        with ExitStack() as stack:
            guard, keys = guarded(stack, moves[each], bare, clock, terminal, virtual, warn)
            status = lambda now, guard=guard, move=moves[each]: guard.over(move.status(now))  # noqa: E731
            screen = make_screen(section.mode, each, profile.limits[each], status, bool(keys))
            guard.notify = screen.notify
            rig = stack.enter_context(open_rig(bare.in_use([each]), clock))
            traces = _Traces(rig, section, each, moves[each])
            notes = [LinkNotes(rig.connections.values(), warnings.append), rig.notes(screen.notify)]
            loop = rig.loop([each], [guard], [traces, *notes, *map(stack.enter_context, keys), screen])
            with signals(loop.interrupt, loop.release_at_once, screen.notify), screen:
                ended = loop.run()
        key = key._replace(version=traces.question.version or key.version)
        if ended.result is not Result.DONE or guard.reason:
            reasons = [*ended.reasons, *([guard.reason] if guard.reason else [])]
            return ResponseReport(ended.result, reasons, key, found, warnings)
        found.append(traces.found())
    return ResponseReport(Result.DONE, [], key, found, warnings)


def keep(report: ResponseReport, store: ResponseStore) -> Sequence[Axis]:
    """Keep what was measured, for later runs; the axes of which the file is not damaged. Raises OutputError."""
    store.read(report.key.rig)
    return [each.axis for each in report.axes if store.keep(report.key, each.axis, each.response)]


class _Traces:
    """An observer of what is sent and read of one axis, after the sinks."""

    def __init__(self, rig: Rig, section: GimbalSection, axis: Axis, move: CalibrationMove) -> None:
        controls = [device.control for device in rig.devices if axis in device.moves and device.control is not None]
        self._control: SpeedControl | None = controls[0] if controls else None
        self.question = VersionQuestion(rig.connections[section.link])
        self._axis, self._move = axis, move
        self._estimator = ResponseEstimator(None, SETTING if section.mode == "stick" else Start())
        self._sent: list[tuple[float, float]] = []
        self._readings: list[Reading] = []
        self._commanded: list[tuple[float, float]] = []  # in mode position: times and positions

    def observe(self, tick: Tick) -> None:
        self.question.ask(tick.time)
        if self._control is None:
            self._note_position(tick.time, tick.motion[self._axis].position)
        if reading := tick.reported.get(self._axis):
            self._estimator.read(reading)
            if not self._readings or reading.time > self._readings[-1].time:
                self._readings.append(reading)
        if self._control is not None and self._axis in self._control.latest:
            self._note(*self._control.latest[self._axis])

    def _note_position(self, time: float, position: float) -> None:
        """A position is a speed since the last one."""
        if self._commanded and time > self._commanded[-1][0]:
            before, place = self._commanded[-1]
            self._note(before, (position - place) / (time - before))
        self._commanded.append((time, position))

    def _note(self, time: float, speed: float) -> None:
        if not self._sent or time > self._sent[-1][0]:
            self._sent.append((time, speed))
            self._estimator.sent(time, speed)

    def found(self) -> AxisResponse:
        """Raises DeviceError when no response explains the readings.

        After a STOP the move has begun anew: what was read before, while a hand may have turned the axis, is out.
        """
        self._readings = [each for each in self._readings if each.time >= self._move.begin]
        response = self._response()
        if response is None:
            raise DeviceError(
                f"{self._axis} did not move, or sent too few readings:"
                " check that the gimbal is unlocked and awake, and measure again"
            )
        model = predicted(self._sent, self._readings, response)
        found = AxisResponse(self._axis, response, self._readings, model)
        if found.rms > MISFIT:
            raise DeviceError(
                f"{self._axis} is {found.rms:.2f} deg from where any response would take it:"
                " check that this gimbal supports this mode"
            )
        return found

    def _response(self) -> Response | None:
        """What is sent positions is not integrated on the way, so its delay can be fitted exactly."""
        of = self._estimator.response
        if self._control is not None:
            return of if self._estimator.sure else None
        read = [(each.time, each.position) for each in self._readings]
        delay = estimate(self._commanded, read, read[0][0], read[-1][0]) if read else None
        if delay is None or not math.isfinite(delay.doubt):
            return None
        return Response(max(0.0, delay.seconds), 0.0, delay.scale, of.drift, delay.doubt, of.gain_doubt, of.drift_doubt)
