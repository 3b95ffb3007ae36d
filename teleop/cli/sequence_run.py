"""A performance on a rig: under the keys and the hands that there are, shown, recorded and reported."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from teleop.cli.drone_run import Aboard, is_flown
from teleop.cli.open_inputs import open_devices
from teleop.cli.running import EXIT_CODES, Extra, commands, perform
from teleop.cli.screens.repeatability_table import PassesReport
from teleop.cli.screens.run_rows import NO_KEYS, RUN_HINTS
from teleop.cli.screens.run_view import RunView
from teleop.cli.screens.take_summary import take_words
from teleop.cli.stop_inputs import open_stop_inputs
from teleop.cli.trim_options import TrimReport
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.interfaces import Clock, Sink
from teleop.core.run_state import Result
from teleop.devices.rig import Rig, open_rig
from teleop.inputs.keyboard import Keyboard
from teleop.manual.live_offset import LiveOffset
from teleop.manual.stop_guard import Relay, StopGuard, Together
from teleop.monitors.repeatability import Repeatability
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.planner.offset_limits import trim_limits
from teleop.recording.writer import recording
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.playback_controls import PlaybackControls
from teleop.sequence.source import SequenceSource
from teleop.sequence.trim_export import TrimmedFile

NOBODY = "play --trim: no joystick and no terminal: plug in a joystick, or run it on a terminal"


@dataclass(frozen=True)
class SequenceRun:
    """`left` is the share of the rig's limits that the source keeps to: less than 1 leaves the rest to a trim."""

    profile: Profile
    performance: CompiledSequence
    source: SequenceSource
    clock: Clock
    keys: Keyboard | None
    left: float = 1.0
    trimmed: TrimmedFile | None = None
    take: Path | None = None
    as_json: bool = False
    patient: bool = False

    def perform(self) -> int:
        """The exit code."""
        source, profile, axes = self.source, self.profile, list(self.performance.move.tracks)
        limits = {axis: profile.limits[axis] for axis in axes}
        extras: list[Extra] = []
        aboard = Aboard()
        with ExitStack() as stack:
            conductor, guard = self._conductor(stack, axes, extras)
            title = self.performance.title
            status = aboard.status if is_flown(axes) else None
            taking = recording(self.take, profile.name, title, limits, status, patient=self.patient, option="--take ")
            recorder = stack.enter_context(taking)
            if source.staging.trigger is not None:
                source.staging.trigger.open(stack)
            rig = stack.enter_context(open_rig(profile, self.clock))
            watchers = self._watchers(stack, rig, axes, [each for each in (conductor, guard) if each], extras)
            status_of = source.status if conductor is None else conductor.status
            keys = NO_KEYS if self.keys is None else RUN_HINTS
            shown = status_of if guard is None else (lambda now: guard.over(status_of(now)))
            display = RunView(title, limits, shown, self.as_json, take_words(recorder), hints=keys)
            aboard.board(rig, axes, display.say, by_script=True)
            tally, sources = TrackingErrorMonitor(lambda: source.begin), [guard or source]
            stopped = (lambda: guard.reason) if guard else (lambda: "")
            if guard:
                guard.say = display.say
            code = perform(rig, axes, sources, tally, display, self.as_json, recorder, watchers, extras, stopped)
            lost = any(isinstance(extra, TrimReport) and extra.failure for extra in extras)
            return code or (EXIT_CODES[Result.FAILED] if lost else code)

    def _conductor(
        self, stack: ExitStack, axes: Sequence[Axis], extras: list[Extra]
    ) -> tuple[PlaybackControls, StopGuard] | tuple[None, None]:
        """What its inputs do to it, if there are any, and their STOP; with a trim also what is reported of that."""
        if self.left == 1.0:
            opened = [] if self.patient else open_stop_inputs(stack, self.profile, self.clock)
            relays = [Relay(each) for each in (*opened, *([] if self.keys is None else [self.keys]))]
            if not relays:
                return None, None
            conductor = PlaybackControls(self.source, Together(relays))
            return conductor, StopGuard(conductor, relays)
        devices, note = open_devices(stack, self.profile, self.clock, self.keys is not None, NOBODY)
        keys = None if self.keys is None else Relay(self.keys)
        relays = [*map(Relay, devices), *([] if keys is None else [keys])]
        limits = {axis: self.profile.limits[axis] for axis in axes}
        trimming = LiveOffset(trim_limits(self.performance.move, limits, self.left), relays, self.profile.sticks)
        if note:
            trimming.say(note)
        report = TrimReport(trimming, self.trimmed)
        extras.append(report)
        conductor = PlaybackControls(self.source, keys, trimming, report.keep)
        return conductor, StopGuard(conductor, relays)

    def _watchers(
        self, stack: ExitStack, rig: Rig, axes: Sequence[Axis], conducting: Sequence[Sink], extras: list[Extra]
    ) -> list[Sink]:
        said: list[str] = []
        stack.callback(lambda: print(*said, sep="\n", end="\n" if said else "", file=sys.stderr))
        watchers: list[Sink] = [*commands(rig, axes, said.append)]
        if self.keys is not None:
            watchers.append(stack.enter_context(self.keys))
        watchers += conducting
        watchers += [extra for extra in extras if isinstance(extra, TrimReport)]
        if self.source.staging.compared:
            repeatability = Repeatability(self.source.place)
            watchers.append(repeatability)
            extras.insert(0, PassesReport(repeatability))
        return watchers
