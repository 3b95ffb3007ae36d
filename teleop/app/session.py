"""A rig that a program has opened: the control loop of its run, and the thread that turns it.

In real time the loop turns in a thread of its own from `open` to `close`. On the virtual clock time passes only while
the program waits for something, so the loop is turned by the waiting thread itself: the same program gives the same
motion every time.
"""

from __future__ import annotations

import atexit
import logging
import threading
import weakref
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from teleop.app.clocks import clock_for
from teleop.app.kept_responses import KeptResponses
from teleop.app.program import Job, ProgramSource
from teleop.app.run import command_sinks
from teleop.app.switch_interval import short_switch_interval
from teleop.config.profile import Profile
from teleop.core.control_loop import ControlLoop
from teleop.core.errors import DeviceError, Interrupted, TeleopError, UsageError
from teleop.core.events import Action
from teleop.core.interfaces import Observer
from teleop.core.run_state import Result, RunState
from teleop.devices.camera_answers import CameraAnswers
from teleop.devices.rig import Rig, open_rig

CLOSING = 15.0  # s to wait for a run to end; the loop's own deadlines are shorter
IMPATIENT = 2  # interrupts while closing, after which devices are released without a ramp
CTRL_C = "Ctrl-C"

log = logging.getLogger(__name__)


class Session:
    """`profile` opened; `axes` are those that it moves and measures. Raises what `open_rig` does."""

    def __init__(self, profile: Profile, virtual: bool) -> None:
        self.profile = profile
        self.axes = [axis for axis in profile.axes if not axis.is_stick]
        if not self.axes:
            raise UsageError(
                f"{profile.name} has no axis that a program can move: a drone needs an operator, with `teleop live`"
            )
        self.program = ProgramSource()
        self._turning = threading.RLock()  # on the virtual clock, the thread that turns the loop
        self._closing = threading.Lock()
        self._stack = ExitStack()
        self.clock = clock_for(virtual)
        self.is_virtual = virtual
        self._thread: threading.Thread | None = None
        self._closed = self._interrupted = False
        self._loop: ControlLoop | None = None
        try:
            used = profile.in_use(self.axes, [Action.RECORD])
            kept = None if virtual else KeptResponses(used, log.warning)  # virtual: the same motion every time
            priors = {} if kept is None else kept.priors
            self.rig: Rig = self._stack.enter_context(open_rig(used, self.clock, priors=priors))
            observers: list[Observer] = [self.program, self._camera(), self.rig.notes(log.info)]
            if kept is not None:
                kept.begin(self.rig, log.info)
                observers.append(kept)
                self._stack.callback(lambda: [log.warning(line) for line in kept.finish().problems])
            self._loop = self.rig.loop(self.axes, [self.program], observers, command_sinks(self.rig, log.info))
            self._supervisor = self._loop.supervisor
            _sessions.add(self)
            self._begin()
        except BaseException:
            self.close()
            raise

    @property
    def over(self) -> bool:
        return self._supervisor.state is RunState.OVER

    @property
    def reason(self) -> str:
        """Why the run ended, "" while it goes on."""
        return "; ".join(self._supervisor.reasons)

    def run(self, job: Job, observers: Sequence[Observer] = ()) -> None:
        """Hand `job` over and wait until it is complete; raises what went wrong.

        An exception in the waiting thread, such as KeyboardInterrupt, first brings the axes to rest.
        """
        self.check()
        self.program.submit(job, observers)
        try:
            self._until(lambda: self.program.finished, self.program.wait)
        except BaseException:
            self.program.cancel(Interrupted("interrupted"))
            self._until(lambda: self.program.finished, self.program.wait)
            raise
        if self._supervisor.state is not RunState.RUNNING:  # a device failed in the tick in which the job ended
            self._until(lambda: self.over, self._join)
            self._raise_interrupt()
            raise DeviceError(self.reason or "the run has ended")
        self.program.result()

    def check(self) -> None:
        """Raises TeleopError once the rig is closed, DeviceError once its run is over."""
        if self._closed:
            raise TeleopError("the rig is closed: open it again with teleop.open()")
        if self._supervisor.state is not RunState.RUNNING:
            raise DeviceError(f"the run has ended: {self.reason or 'closed'}; open the rig again")

    def camera_waiting(self) -> bool:
        """Whether an answer of the camera is still due."""
        return self.rig.camera is not None and self.rig.camera.waiting

    def close(self) -> None:
        """Ramp to rest, release every device, close the links. May be called again, from any thread."""
        with self._closing:
            if self._closed:
                return
            self._closed = True
            try:
                if self._loop is not None:
                    self._loop.interrupt("closed by the program")
                    self._until(lambda: self.over, self._join)
            finally:
                self._stack.close()
                self._loop = None  # the planner's objects end here, not with the interpreter
                _sessions.discard(self)
        self._raise_interrupt()

    def _camera(self) -> Observer:
        """What reads the camera's answers; an action that the camera refuses ends the job in hand, and not the run."""
        answers = CameraAnswers(self.rig.camera, log.info)
        if self.rig.camera is not None:
            self.rig.camera.on_failed = lambda _action, reason: self._refused(reason)
        return answers

    def _refused(self, reason: str) -> None:
        if not self.program.cancel(DeviceError(reason)):
            log.warning(reason)

    def _begin(self) -> None:
        if not self.is_virtual:
            self._stack.enter_context(short_switch_interval)
            self._thread = threading.Thread(target=self._turn_all, name="teleop control", daemon=True)
            self._thread.start()
        self._until(lambda: self.program.running.is_set(), self.program.running.wait)
        self._raise_interrupt()
        if self.over:
            raise DeviceError(self.reason)

    def _turn_all(self) -> None:
        loop = self._loop
        try:
            if loop is not None:
                loop.run()
        finally:
            self._ended()

    def _ended(self) -> None:
        done = self._supervisor.result is Result.DONE
        self.program.end(DeviceError(self.reason or ("done" if done else "the run has ended")))

    def _until(self, condition: Callable[[], bool], wait: Callable[[], object]) -> None:
        """Wait for `condition`: on the virtual clock by turning the loop, else with `wait`."""
        if not self.is_virtual:
            wait()
            return
        with self._turning:
            while not self.over and not condition() and self._loop is not None:
                self._loop.turn()
            if self.over:
                self._ended()

    def _join(self) -> None:
        """Wait for the control thread's end, through a Ctrl-C too; the next one releases without a ramp."""
        interrupts = 0
        while self._thread is not None and interrupts < IMPATIENT:
            try:
                self._thread.join(CLOSING)
                return
            except KeyboardInterrupt:
                interrupts += 1
                self._interrupted = True
        if self._loop is not None:
            self._loop.release_at_once()

    def _raise_interrupt(self) -> None:
        """Raise, once, the KeyboardInterrupt that the loop, or the wait for its end, has taken for the program."""
        if self._interrupted or (self.is_virtual and CTRL_C in self._supervisor.reasons):
            self._interrupted = False
            if CTRL_C in self._supervisor.reasons:
                self._supervisor.reasons[self._supervisor.reasons.index(CTRL_C)] = "interrupted"
            raise KeyboardInterrupt


_sessions: weakref.WeakSet[Session] = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    """A rig that the program has left open is brought to rest and released as the interpreter ends."""
    for session in list(_sessions):
        session.close()
