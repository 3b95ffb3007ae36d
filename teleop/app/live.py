"""A rig in an operator's hands, or moved by recorded sticks.

Recorded sticks alone need neither a joystick nor a terminal: then only the STOP of what is plugged in counts.
Everything else goes through the `Operator`; what is recorded then drives the axes that no input does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from teleop.app.absent_devices import open_present
from teleop.app.beside import BesideLive, both
from teleop.app.drone_flight import Aboard, is_flown
from teleop.app.kept_responses import KeptResponses
from teleop.app.operator_inputs import open_devices
from teleop.app.run import RunReport, Screen, Signals, commands, run
from teleop.app.shoot_runner import LOOK, RETRY
from teleop.app.stop_inputs import open_stop_inputs
from teleop.app.target_file import TargetFile
from teleop.config.presets import Presets, default_file, read_presets
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.errors import LinkError
from teleop.core.interfaces import Clock, Observer, Sink, Source
from teleop.core.operator_input import Input
from teleop.core.run_status import RunStatus
from teleop.devices.camera_answers import CameraAnswers
from teleop.devices.connection import Connection
from teleop.devices.drone.state import DroneState
from teleop.devices.rig import Rig, open_rig
from teleop.inputs.hid.recording import AFTER, Recording
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.recorded_sticks import Sticks, SticksSource
from teleop.inputs.stick_shaping import shape
from teleop.manual.operator import Operator
from teleop.manual.stop_guard import Relay, StopGuard
from teleop.manual.target_marks import TargetMarks
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.writer import Recorder, recording

NO_INPUT = "live: no joystick and no terminal: plug in a joystick, run it on a terminal, or give --sticks"


@dataclass(frozen=True)
class LiveParts:
    """What the screen of a run by hand shows."""

    limits: Mapping[Axis, Limits]
    operator: Operator
    connections: Mapping[str, Connection]
    recorder: Recorder | None
    drone: Callable[[], DroneState | None]


@dataclass
class _Opened:
    """What the first run has opened, and later ones go on with; `last` is the report of the last of them."""

    axes: Sequence[Axis]
    recorder: Recorder | None
    last: RunReport | None = None

    def reported(self, ended: RunReport | LinkError) -> RunReport:
        """The report of all of them."""
        assert self.last is not None
        report = self.last if isinstance(ended, LinkError) else ended
        if self.recorder is not None:
            self.recorder.finish(report.result, report.reasons, report.links)
        return replace(report, take=self.recorder)


MakeReplayScreen = Callable[[Mapping[Axis, Limits], Callable[[float], RunStatus], Recorder | None], Screen]


@dataclass(frozen=True)
class LiveRun:
    """`recorded` sticks drive beside the inputs, `recordings` are inputs; `keyboard` is None without a terminal.

    In `virtual` time only what is recorded counts.
    """

    profile: Profile
    title: str
    clock: Clock
    keyboard: Keyboard | None
    recorded: Sticks | None = None
    recordings: Sequence[Recording] = ()
    presets: Path | None = None
    take: Path | None = None
    virtual: bool = False
    targets: Path | None = None
    beside: BesideLive | None = None

    def by_hand(self, make_screen: Callable[[LiveParts], Screen], signals: Signals) -> RunReport:
        """Until the operator or what is recorded ends it. Raises TeleopError for what keeps it from beginning.

        What those beside it do may outlast a run that failed: then the rig is opened again.
        """
        with ExitStack() as outer:
            aboard = Aboard()
            kept_open: _Opened | None = None
            while True:
                ended: RunReport | LinkError
                try:
                    with ExitStack() as stack:
                        kept_open, ended = self._one_run(outer, stack, kept_open, aboard, make_screen, signals)
                except LinkError as error:
                    if kept_open is None:
                        raise
                    ended = error
                if self.beside is None or not self.beside.goes_on(ended) or not self._waits(self.beside, signals):
                    return kept_open.reported(ended)

    def _one_run(
        self,
        outer: ExitStack,
        stack: ExitStack,
        before: _Opened | None,
        aboard: Aboard,
        make_screen: Callable[[LiveParts], Screen],
        signals: Signals,
    ) -> tuple[_Opened, RunReport]:
        """What is opened with the first run lasts until `outer` is left."""
        profile = self.profile
        sticks = self.recorded if not self.recordings else _until_end(self.recorded, self.recordings)
        replay = None if sticks is None else self.replay(sticks)
        inputs, note = self._inputs(stack, replay)
        damage: list[str] = []
        kept = KeptResponses(profile, damage.append)
        rig, axes, left_out = self._opened(stack, kept)
        limits = {axis: profile.limits[axis] for axis in axes}
        if before is not None and set(before.axes) != set(axes):
            raise LinkError("not every device of the run before is there")
        shelf = read_presets(self.presets or default_file(profile.name), limits, profile.name)
        stack.callback(shelf.close)
        if self.beside is not None and before is None:
            self.beside.open(outer, profile, limits)
        targets = None if self.targets is None else TargetFile(self.targets)
        operator = self._operator(limits, inputs, shelf, replay, targets)
        if targets is not None:
            stack.callback(targets.close)
        for line in (*damage, *left_out, *([note] if note else [])):
            operator.notify(line)
        status = lambda: aboard.status(operator.status)  # noqa: E731
        opened = before or _Opened(axes, self._recorder(outer, limits, status, patient=self.virtual))
        if opened.recorder is not None:
            opened.recorder.status = status
        aboard.board(rig, axes, operator.notify, by_script=False)
        screen = make_screen(LiveParts(limits, operator, rig.connections, opened.recorder, aboard.state))
        observers, sinks = self._watched(rig, axes, operator, lenient=replay is None)
        observers += [] if targets is None else [targets]
        if self.beside is not None:
            observer, sink = self.beside.attach(outer, operator, shelf, rig)
            observers, sinks = [*observers, observer], [*sinks, sink]
        observers += [] if opened.recorder is None else [opened.recorder]
        tracking, stopped = TrackingErrorMonitor(lambda: operator.begin), (lambda: operator.reason)
        report = run(rig, axes, [operator], tracking, screen, signals, None, observers, sinks, stopped, kept)
        opened.last = report
        return opened, report

    def _inputs(self, stack: ExitStack, replay: SticksSource | None) -> tuple[Sequence[Input], str]:
        """The joysticks and the recordings of devices, and a line where something is missing."""
        begin = (lambda: math.inf) if replay is None else (lambda: replay.begin)
        alone = self.keyboard is not None or self.beside is not None
        return open_devices(stack, self.profile, self.clock, alone, NO_INPUT, self.recordings, begin, self.virtual)

    def _operator(
        self,
        limits: Mapping[Axis, Limits],
        inputs: Sequence[Input],
        shelf: Presets,
        replay: SticksSource | None,
        targets: TargetFile | None,
    ) -> Operator:
        """Who acts on the inputs, the keyboard and those beside included."""
        own = [*inputs, *([] if self.keyboard is None else [self.keyboard])]
        beneath: Source | None = replay
        if self.beside is not None:
            own, beneath = [*own, *self.beside.inputs], self.beside.beneath
        marks = None if targets is None else TargetMarks(targets.height, targets.add)
        operator = Operator(limits, own, shelf, self.profile.sticks, self.profile.presets.recall, beneath, marks)
        if targets is not None:
            targets.notify = operator.notify
        return operator

    def _waits(self, beside: BesideLive, signals: Signals) -> bool:
        """A moment, before the rig is tried again; whether another run is wanted."""
        interrupted: list[str] = []
        nothing: Callable[..., None] = lambda *_: None  # noqa: E731
        with signals(interrupted.append, nothing, nothing):
            end = self.clock.now() + RETRY
            while (now := self.clock.now()) < end:
                if interrupted or not beside.wait(now):
                    return False
                self.clock.sleep_until(min(end, now + LOOK))
        return True

    def unattended(
        self,
        status: Callable[[SticksSource], Callable[[float], RunStatus]],
        make_screen: MakeReplayScreen,
        signals: Signals,
        warn: Callable[[str], object],
    ) -> RunReport:
        """The recorded sticks alone, to their last row."""
        assert self.recorded is not None
        replay, axes, aboard = self.replay(self.recorded), list(self.recorded.axes), Aboard()
        limits = {axis: self.profile.limits[axis] for axis in axes}
        with ExitStack() as stack:
            devices = [] if self.virtual else open_stop_inputs(stack, self.profile, self.clock, warn)
            guard, shown = StopGuard(replay, [Relay(each) for each in devices]), status(replay)
            recorder = self._recorder(stack, limits, aboard.status if is_flown(axes) else None, patient=self.virtual)
            screen = make_screen(limits, lambda now: guard.over(shown(now)), recorder)
            guard.notify = screen.notify
            kept = KeptResponses(self.profile, warn)
            rig = stack.enter_context(open_rig(self.profile, self.clock, priors=kept.priors))
            aboard.board(rig, axes, screen.notify, by_script=True)
            tracking = TrackingErrorMonitor(lambda: replay.begin)
            return run(
                *(rig, axes, [guard], tracking, screen, signals, recorder), stopped=lambda: guard.reason, kept=kept
            )

    def replay(self, recorded: Sticks) -> SticksSource:
        """Recorded sticks, with the dead zone and expo of the profile where it has them."""
        shaping = self.profile.sticks

        def velocity(axis: Axis, deflection: float) -> float:
            share = shaping.speed * shape(deflection, shaping.dead_zone or 0.0, shaping.expo or 0.0)
            return share * self.profile.axes[axis].velocity

        return SticksSource(recorded, velocity)

    def _opened(self, stack: ExitStack, kept: KeptResponses) -> tuple[Rig, Sequence[Axis], Sequence[str]]:
        """The rig, its axes, and a line for each that is absent; recorded sticks need all of theirs."""
        if self.recorded is None:
            return open_present(stack, self.profile, self.clock, kept.priors)
        axes = list(self.profile.axes) if self.recordings else self.recorded.axes
        return stack.enter_context(open_rig(self.profile, self.clock, priors=kept.priors)), axes, ()

    def _recorder(
        self, stack: ExitStack, limits: Mapping[Axis, Limits], status: Callable[[], object] | None, patient: bool
    ) -> Recorder | None:
        context = recording(self.take, self.profile.name, self.title, limits, status, patient=patient, option="--take ")
        return stack.enter_context(context)

    def _watched(
        self, rig: Rig, axes: Sequence[Axis], operator: Operator, lenient: bool
    ) -> tuple[list[Observer], Sequence[Sink]]:
        notify, confirmed, answered = operator.notify, operator.confirmed, operator.camera_answered
        if (beside := self.beside) is not None:
            notify, confirmed = both(notify, beside.line), both(confirmed, beside.confirmed)
            answered = both(answered, beside.camera_answered)
        observers, sinks = commands(rig, axes, notify, confirmed)
        camera = CameraAnswers(rig.camera, notify, answered, lenient=lenient)
        return [*observers, camera, *([] if self.keyboard is None else [self.keyboard])], sinks


def _until_end(sticks: Sticks | None, recordings: Sequence[Recording]) -> Sticks:
    """The recorded sticks, or none, until a moment after the last row of the last recording of a device."""
    end = max(each.end for each in recordings) + AFTER
    if sticks is None:
        return Sticks([], [0.0, end], [[], []])
    if sticks.times[-1] >= end:
        return sticks
    rest = [0.0] * len(sticks.axes)
    return Sticks(sticks.axes, [*sticks.times, end], [*sticks.deflections[:-1], rest, rest])
