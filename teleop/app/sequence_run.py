"""A planned sequence on a rig: under the keys and inputs that there are, observed, recorded and reported."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from teleop.app.beside import BesideRun, Running, heard
from teleop.app.drone_flight import Aboard, is_flown
from teleop.app.kept_responses import KeptResponses
from teleop.app.operator_inputs import open_devices
from teleop.app.played_status import PlayedStatus, as_planned, facts_of
from teleop.app.run import RunReport, Screen, Signals, commands, run
from teleop.app.stop_inputs import open_stop_inputs
from teleop.app.trim_writer import TrimWriter
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.interfaces import Clock
from teleop.core.operator_input import Input
from teleop.core.run_status import RunStatus
from teleop.devices.rig import Rig, open_rig
from teleop.inputs.keyboard import Keyboard
from teleop.manual.live_offset import LiveOffset
from teleop.manual.stop_guard import KEYS_PERIOD, Relay, StopGuard, Together
from teleop.monitors.repeatability import Repeatability
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.planner.offset_limits import trim_limits
from teleop.recording.writer import Recorder, recording
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.playback_controls import PlaybackControls
from teleop.sequence.progress import run_status
from teleop.sequence.source import SequenceSource
from teleop.sequence.trim_export import TrimmedFile

if TYPE_CHECKING:
    from teleop.learning.pass_learner import PassLearner
    from teleop.learning.pass_traces import PassObserver

NO_INPUT = "play --trim: no joystick and no terminal: plug in a joystick, or run it on a terminal"

MakeScreen = Callable[[Mapping[Axis, Limits], Callable[[float], RunStatus], Recorder | None], Screen]
"""Makes the screen of a run from its limits, its status at a time of the loop's, and what records it."""


@dataclass(frozen=True)
class SequenceReport:
    """How the run went; the trim that an operator gave it, and how its passes compare, where there were any."""

    run: RunReport
    trim: TrimWriter | None = None
    repeatability: Repeatability | None = None


@dataclass(frozen=True)
class SequenceRun:
    """`share` is that of the rig's limits that the source keeps to: less than 1 leaves the rest to a trim.

    `notify` gets a line for what the gimbal answers and what the links report, `warn` for an input
    that is absent. What it finds of how the axes answer is kept for the next run.
    """

    profile: Profile
    sequence: CompiledSequence
    source: SequenceSource
    clock: Clock
    keys: Keyboard | None
    notify: Callable[[str], object]
    warn: Callable[[str], object]
    share: float = 1.0
    trimmed: TrimmedFile | None = None
    take: Path | None = None
    patient: bool = False
    learner: PassLearner | None = None
    beside: BesideRun | None = None

    @property
    def axes(self) -> list[Axis]:
        return list(self.sequence.move.tracks)

    @property
    def limits(self) -> dict[Axis, Limits]:
        return {axis: self.profile.limits[axis] for axis in self.axes}

    def perform(self, make_screen: MakeScreen, signals: Signals) -> SequenceReport:
        """Play it to its end. Raises TeleopError for what keeps it from beginning."""
        source, axes, aboard = self.source, self.axes, Aboard()
        with ExitStack() as stack:
            if self.beside is not None:
                self.beside.open(stack, self.profile, self.limits, self.clock)
            controls, guard, trim = self._controls(stack)
            recorder = stack.enter_context(self._recording(aboard))
            if source.cycle.trigger is not None:
                source.cycle.trigger.open(stack)
            kept = KeptResponses(self.profile, self.warn)
            rig = stack.enter_context(open_rig(self.profile, self.clock, priors=kept.priors))
            rig.foresee(source.foreseen)
            source.rest_needed = partial(rig.rest_needed, axes)
            planned = partial(as_planned, source, self.sequence.move)
            played = None if self.take is None or is_flown(axes) else PlayedStatus(source, self.sequence.move, rig)
            if recorder and played:
                recorder.status = played
            repeatability = Repeatability(source.place, planned) if source.cycle.compared else None
            observers, sinks = commands(rig, axes, heard(self.notify, self.beside))
            keys = None if self.keys is None else stack.enter_context(self.keys)
            observers += [each for each in (keys, trim, repeatability, self._observed(rig), played) if each is not None]
            status_of = partial(run_status, source) if controls is None else controls.status
            shown = status_of if guard is None else (lambda now: guard.over(status_of(now)))
            screen = make_screen(self.limits, shown, recorder)
            if self.beside is not None:
                running = Running(self.sequence.title, lambda: guard, screen.notify, self.source, drone=aboard.state)
                observers.append(self.beside.attach(stack, running))
            aboard.board(rig, axes, screen.notify, by_script=True)
            if guard:
                guard.notify = heard(screen.notify, self.beside)
            tracking = TrackingErrorMonitor(lambda: source.begin, planned)
            stopped = lambda: guard.reason if guard else ""  # noqa: E731 - one of several arguments
            if self.learner:
                self.learner.notify = screen.notify
            sources = [guard or source]
            report = run(rig, axes, sources, tracking, screen, signals, recorder, observers, sinks, stopped, kept)
            if self.learner:
                self.learner.notify = self.notify  # the screen is gone
                self.learner.finish()
            return SequenceReport(report, trim, repeatability)

    def _observed(self, rig: Rig) -> PassObserver | None:
        """What sees the passes for the learner."""
        if self.learner is None:
            return None
        from teleop.app.learning import observe_passes  # with scipy, only where something is learned

        return observe_passes(self.learner, self.source, rig)

    def _recording(self, aboard: Aboard) -> AbstractContextManager[Recorder | None]:
        status, title = aboard.status if is_flown(self.axes) else None, self.sequence.title
        patient, option = self.patient, "--take "
        facts = facts_of(self.sequence)
        return recording(
            self.take, self.profile.name, title, self.limits, status, patient=patient, option=option, sequence=facts
        )

    def _controls(self, stack: ExitStack) -> tuple[PlaybackControls | None, StopGuard | None, TrimWriter | None]:
        """What its inputs do to it, if there are any, and their STOP; with a trim also what writes that."""
        if self.share < 1:
            return self._trim_controls(stack)
        opened = [] if self.patient else open_stop_inputs(stack, self.profile, self.clock, self.warn)
        relays = [Relay(each) for each in (*opened, *([] if self.keys is None else [self.keys]), *self._beside_inputs)]
        if not relays:
            return None, None, None
        controls = PlaybackControls(self.source, Together(relays))
        return controls, self._guard(controls, relays), None

    @property
    def _beside_inputs(self) -> Sequence[Input]:
        return () if self.beside is None else self.beside.inputs

    def _guard(self, controls: PlaybackControls, relays: Sequence[Relay]) -> StopGuard:
        poll = KEYS_PERIOD if self.beside is None else self.beside.poll
        return StopGuard(controls, relays, poll=poll)

    def _trim_controls(self, stack: ExitStack) -> tuple[PlaybackControls, StopGuard, TrimWriter]:
        devices, note = open_devices(stack, self.profile, self.clock, self.keys is not None, NO_INPUT)
        keys = None if self.keys is None else Relay(self.keys)
        relays = [*map(Relay, devices), *([] if keys is None else [keys]), *map(Relay, self._beside_inputs)]
        limits = trim_limits(self.sequence.move, self.limits, self.share)
        trimming = LiveOffset(limits, relays, self.profile.sticks)
        if note:
            trimming.notify(note)
        trim = TrimWriter(trimming, self.trimmed)
        controls = PlaybackControls(self.source, keys, trimming, trim.keep)
        return controls, self._guard(controls, relays), trim
