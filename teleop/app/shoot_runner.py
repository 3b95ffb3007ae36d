"""A timelapse on a rig: run after run until it is over, and the journal through all of them.

A run is an ordinary one, that any fault ends smoothly. What ended it for a reason that passes, a link that was lost or
a computer that stalled, is followed by another run of the same shoot, from the frame that the journal says is next: so
going on after an hour without a cable is no other code than going on after a power cut.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from teleop.app.kept_responses import KeptResponses
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.config.sinks_section import CameraSection
from teleop.core.control_loop import ControlLoop, StallError
from teleop.core.errors import LinkError
from teleop.core.interfaces import Clock, Observer
from teleop.core.operator_input import Input
from teleop.core.run_state import Result
from teleop.core.run_status import RunStatus
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import open_rig
from teleop.devices.shutter import ShutterSink
from teleop.inputs.keyboard import CLOSED
from teleop.manual.stop_guard import Relay, StopGuard, Together
from teleop.timelapse.by_hand import ByHandSource
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.go_motion import mover_of
from teleop.timelapse.journal import FrameState, Journal
from teleop.timelapse.movers import Mover
from teleop.timelapse.so_far import InDoubt, settle_doubt, so_far
from teleop.timelapse.source import TimelapseSource

LOOK = 0.1  # s between looks for a signal while waiting, and at the inputs while nothing moves
RETRY = 2.0  # s between two tries to reach a rig that was lost
LONGEST_WAIT = 24 * 3600.0  # s of such pauses in a row, after which the shoot ends
STALLS = 5  # runs in a row that a stalled computer may end without a frame
COUNTED = (FrameState.DONE, FrameState.DOUBTFUL)  # as shot


@dataclass(frozen=True)
class Ended:
    """How a shoot ended: as a run does."""

    result: Result
    reasons: Sequence[str]


def camera_link(profile: Profile) -> str:
    """The link of the camera to shoot with; raises DocumentError where there is none."""
    links = [section.link for section in profile.sinks if isinstance(section, CameraSection)]
    if not links:
        raise DocumentError([f"{profile.name} has no camera to shoot with: sinks needs {{type: camera, link: ...}}"])
    return links[0]


def passes_by_itself(faults: Sequence[BaseException], wait_for_link: bool, fruitless: int) -> bool:
    """Whether what ended a run does: a link's loss where that is waited for, a stall of the computer.

    `fruitless` is how many runs in a row have brought no frame.
    """
    if faults and isinstance(faults[0], LinkError):
        return wait_for_link and str(faults[0]) != CLOSED  # the operator's own end is gone, not the rig's
    return bool(faults) and isinstance(faults[0], StallError) and fruitless < STALLS


class Shooting:
    """One shoot: its journal is open, `notify` tells the operator a line, `observers` see every run.

    `keys` and `inputs` can stop it; a STOP that is not cleared outlasts a run.
    """

    def __init__(
        self,
        timelapse: Timelapse,
        profile: Profile,
        clock: Clock,
        journal: Journal,
        notify: Callable[[str], object],
        observers: Sequence[Observer] = (),
        keys: Input | None = None,
        in_doubt: InDoubt = "shoot",
        executor: Executor | None = None,
        inputs: Sequence[Input] = (),
        by_hand: bool = False,
        look: float = LOOK,
    ) -> None:
        self._look = look
        self._timelapse, self._profile, self._clock, self._journal = timelapse, profile, clock, journal
        self._notify, self._observers = notify, observers
        self._in_doubt: InDoubt = in_doubt
        self._executor = executor
        self._inputs = [*([] if keys is None else [keys]), *inputs]
        self.guard: StopGuard | None = None
        self._camera = camera_link(profile)
        self.progress = so_far(timelapse, journal, by_hand)
        self._begin = math.inf  # when the first frame of the first run was due
        self._source: TimelapseSource | ByHandSource | None = None
        self.links: Mapping[str, Mapping[str, int]] = {}
        self._slot = -math.inf  # when the frame that is next is due
        self._interrupted = ""
        self._loop: ControlLoop | None = None
        self._runs = 0

    @property
    def begin(self) -> float:
        """When the first frame of the first run is due, on the clock; inf as long as that is not known."""
        return min(self._begin, self._source.begin) if self._source else math.inf

    def shown(self, status: RunStatus) -> RunStatus:
        """What a view shows of it: the status, and over it a STOP, or a pause, that holds the axes."""
        return self.guard.over(status) if self.guard else status

    def run(self) -> Ended:
        """Shoot until it is over. Raises LinkError where the rig cannot be reached at first."""
        fruitless, waiting, waited = 0, False, 0.0
        while True:
            before = self.progress.shot
            settle_doubt(journal=self._journal, progress=self.progress, in_doubt=self._in_doubt, notify=self._notify)
            if self._journal.next >= self._timelapse.frames:
                return self._finished()
            ended, faults, reached = self._one_run()
            fruitless = 0 if self.progress.shot > before else fruitless + 1
            if ended.result is not Result.FAILED or not self._may_go_on(faults, reached, waiting, fruitless):
                return ended
            waiting = isinstance(faults[0], LinkError) or not reached
            if reached:
                line = "waiting for the link, then going" if waiting else "going"
                self._notify(f"{ended.reasons[0]}: {line} on at frame {self._journal.next}")
            waited = waited + RETRY if waiting and not reached else 0.0
            if waited > LONGEST_WAIT:
                return ended
            if not self._rests(RETRY if waiting else 0.0):
                return Ended(Result.INTERRUPTED, [self._interrupted])

    def _finished(self) -> Ended:
        """The last frame is behind, and all that was left was to write that down."""
        note = self._journal.finish()
        self._journal.catch_up()
        if note.safe:
            return Ended(Result.DONE, [])
        return Ended(Result.FAILED, [self._journal.trouble or f"{self._journal.path}: the disk does not answer"])

    def _one_run(self) -> tuple[Ended, Sequence[BaseException], bool]:
        """How it ended, what was raised in it, and whether the rig was reached."""
        timelapse, first = self._timelapse, self._journal.next
        mover = mover_of(timelapse, self._executor)
        relays = [Relay(each) for each in self._inputs]
        keys = Together(relays) if relays else None
        source = self._source_of(mover, first, keys)
        self._source = source
        guard = StopGuard(source, relays, self._notify, self._look, self.guard.stopped_by if self.guard else "")
        self.guard = guard
        self._runs += 1
        try:
            kept = KeptResponses(self._profile, self._notify)
            with open_rig(self._profile, self._clock, priors=kept.priors) as rig:
                kept.begin(rig, self._notify)
                rig.foresee(mover.foreseen)
                shutter = ShutterSink(rig.connections[self._camera], source.on_shutter_result)
                notes = LinkNotes(rig.connections.values(), self._notify), rig.notes(self._notify)
                self._loop = rig.loop(list(timelapse.limits), [guard], [*notes, kept, *self._observers], [shutter])
                if self._interrupted:
                    self._loop.interrupt(self._interrupted)
                supervisor = self._loop.run()
                for line in kept.finish().problems:
                    self._notify(line)
                self.links = {name: connection.counts for name, connection in rig.connections.items()}
        except LinkError as error:
            if self._runs == 1:
                raise
            return Ended(Result.FAILED, [str(error)]), [error], False
        source.leave()
        self._journal.catch_up()
        reached = source.begin < math.inf
        if reached:
            self._begin = min(self._begin, source.begin)
            halted = guard.halted  # then no slot passes
            self._slot = -math.inf if halted else source.due_at(self._journal.next, self._clock.now())
        supervisor.reasons += [guard.reason] if guard.reason else []
        return Ended(supervisor.result, supervisor.reasons), self._loop.faults, reached

    def _source_of(self, mover: Mover, first: int, keys: Input | None) -> TimelapseSource | ByHandSource:
        timelapse, journal, progress = self._timelapse, self._journal, self.progress
        if not progress.by_hand:
            return TimelapseSource(timelapse, mover, journal, first, progress, self._slot, keys)
        first = progress.frame if self._runs else first  # where the operator was
        shot = {frame for frame, state in journal.frames.items() if state in COUNTED}
        return ByHandSource(timelapse, mover, journal, first, progress, keys, shot)

    def _may_go_on(self, faults: Sequence[BaseException], reached: bool, waiting: bool, fruitless: int) -> bool:
        """Whether what ended a run passes by itself. A rig that is waited for may also be there and not yet answer."""
        if waiting and not reached:
            return True
        return passes_by_itself(faults, self._profile.timelapse.wait_for_link and reached, fruitless)

    def interrupt(self, reason: str) -> None:
        """Stop smoothly; safe to call from a signal handler, again and again."""
        self._interrupted = reason
        if self._loop is not None:
            self._loop.interrupt(reason)

    def release_at_once(self) -> None:
        """One attempt to release every device; safe to call from another thread."""
        if self._loop is not None:
            self._loop.release_at_once()

    def _rests(self, seconds: float) -> bool:
        """Wait, but not past a signal; whether there was none."""
        end = self._clock.now() + seconds
        while not self._interrupted and self._clock.now() < end:
            self._clock.sleep_until(min(end, self._clock.now() + LOOK))
        return not self._interrupted
