"""A timelapse shot on a rig, with its journal, a take and the inputs that can stop it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from teleop.app.beside import BesideRun, Running, heard
from teleop.app.run import Screen, Signals, undisturbed
from teleop.app.shoot_runner import LOOK, Ended, InDoubt, Shooting, camera_link
from teleop.app.stop_inputs import open_stop_inputs
from teleop.config.profile import Profile
from teleop.core.interfaces import Clock, Observer
from teleop.inputs.keyboard import Keyboard
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.writer import Recorder, recording
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.journal import ENDING, Journal, Shoot, open_journal

MakeScreen = Callable[[Shooting, Path, Recorder | None], Screen]
"""Makes the screen of a shoot, its journal's path and what records it."""


@dataclass(frozen=True)
class ShootReport:
    """How a shoot ended, with what was shot, what is next, and how well the rig followed."""

    ended: Ended
    shooting: Shooting
    journal: Journal
    tracking: TrackingErrorMonitor
    take: Recorder | None


@dataclass(frozen=True)
class ShootRun:
    """`file` names the journal, in the current folder; `resume` and `restart` say what becomes of one that is there."""

    file: str
    timelapse: Timelapse
    profile: Profile
    clock: Clock
    keys: Keyboard | None
    resume: bool = False
    restart: bool = False
    in_doubt: InDoubt = "shoot"
    take: Path | None = None
    virtual: bool = False
    by_hand: bool = False
    beside: BesideRun | None = None

    def perform(
        self, make_screen: MakeScreen, signals: Signals, begun: Callable[[Path], object], warn: Callable[[str], object]
    ) -> ShootReport:
        """Shoot it, from the first frame or from where it stopped; `begun` is called with the journal's path.

        Raises TeleopError for what keeps it from beginning.
        """
        timelapse, path = self.timelapse, Path(Path(self.file).stem + ENDING)
        belongs = Shoot(Path(self.file).name, timelapse.identity, timelapse.frames)
        camera_link(self.profile)  # refused before a journal is begun
        with ExitStack() as stack:
            options = {"resume": self.resume, "restart": self.restart, "patient": self.virtual}
            journal = stack.enter_context(open_journal(path, belongs, **options))
            recorder = self._recorder(stack)
            keys = None if self.keys is None else stack.enter_context(self.keys)
            observers: list[Observer] = [each for each in (recorder, keys) if each is not None]
            beside = self.beside
            if beside is not None:
                beside.open(stack, self.profile, timelapse.limits, self.clock)
            notify = heard(lambda line: screen.notify(line), beside)  # the screen is made with what it shows
            shooting = self._shooting(stack, journal, observers, notify, warn)
            screen = make_screen(shooting, path, recorder)
            if beside is not None:
                running = Running(timelapse.title, lambda: shooting.guard, screen.notify, progress=shooting.progress)
                observers.append(beside.attach(stack, running))
            tracking = TrackingErrorMonitor(lambda: shooting.begin)
            observers += [tracking, screen]
            begun(path)
            with undisturbed(), signals(shooting.interrupt, shooting.release_at_once, screen.notify), screen:
                ended = shooting.run()
            if recorder is not None:
                recorder.finish(ended.result, ended.reasons, shooting.links)
            journal.catch_up()
            return ShootReport(ended, shooting, journal, tracking, recorder)

    def _recorder(self, stack: ExitStack) -> Recorder | None:
        title, limits = self.timelapse.title, self.timelapse.limits
        context = recording(self.take, self.profile.name, title, limits, patient=self.virtual, option="--take ")
        return stack.enter_context(context)

    def _shooting(
        self,
        stack: ExitStack,
        journal: Journal,
        observers: Sequence[Observer],
        notify: Callable[[str], object],
        warn: Callable[[str], object],
    ) -> Shooting:
        inputs = [] if self.virtual else open_stop_inputs(stack, self.profile, self.clock, warn)
        beside = self.beside
        return Shooting(
            *(self.timelapse, self.profile, self.clock, journal, notify, observers, self.keys, self.in_doubt),
            inputs=[*inputs, *([] if beside is None else beside.inputs)],
            by_hand=self.by_hand,
            look=LOOK if beside is None else beside.poll,
        )
