"""A rig that a program has opened: the control loop of its run, and the thread that turns it.

In real time the loop turns in a thread of its own from `open` to `close`. On the virtual clock time passes only while
the program waits for something, so the loop is turned by the waiting thread itself: the same program gives the same
motion every time.
"""

from __future__ import annotations

import math
import sys
import threading
from collections.abc import Callable
from contextlib import ExitStack

from teleop.app.program import Job, ProgramSource
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.control_loop import ControlLoop
from teleop.core.errors import DeviceError, TeleopError
from teleop.core.events import Action
from teleop.core.run_state import Result, RunState
from teleop.devices.rig import Rig, open_rig

SWITCH_INTERVAL = 0.0005  # s: how long another thread of the program may hold up the control thread
CLOSING = 15.0  # s until a run that is told to end is left to itself; the loop's own deadlines are shorter


class Session:
    """`profile` opened; `axes` are those that it moves and measures. Raises what `open_rig` does."""

    def __init__(self, profile: Profile, virtual: bool) -> None:
        self.profile = profile
        self.axes = [axis for axis in profile.axes if not axis.is_stick]
        self.program = ProgramSource()
        self._virtual = virtual
        self._turning = threading.RLock()  # on the virtual clock, the thread that turns the loop
        self._stack = ExitStack()
        self.clock = VirtualClock() if virtual else SystemClock()
        self._thread: threading.Thread | None = None
        self._closed = False
        try:
            self.rig: Rig = self._stack.enter_context(open_rig(profile.in_use(self.axes, [Action.RECORD]), self.clock))
            self._loop: ControlLoop = self.rig.loop(self.axes, [self.program], [self.program])
            self._begin()
        except BaseException:
            self._stack.close()
            raise

    @property
    def is_virtual(self) -> bool:
        return self._virtual

    @property
    def over(self) -> bool:
        return self._loop.supervisor.state is RunState.OVER

    @property
    def reason(self) -> str:
        """Why the run ended, "" while it goes on."""
        return "; ".join(self._loop.supervisor.reasons)

    def run(self, job: Job) -> None:
        """Hand `job` over and wait until it is complete; raises what went wrong."""
        self.check()
        self.program.submit(job)
        self._until(lambda: self.program.finished)
        self.program.result()

    def check(self) -> None:
        """Raises DeviceError once the run is over."""
        if self._closed:
            raise TeleopError("the rig is closed")
        if self.over:
            raise DeviceError(f"the run has ended: {self.reason or 'closed'}")

    def close(self) -> None:
        """Ramp to rest, release every device, close the links. May be called again."""
        if self._closed:
            return
        self._closed = True
        try:
            self._loop.interrupt("closed by the program")
            if self._thread is None:
                self._until(lambda: self.over)
            else:
                self._thread.join(CLOSING)
        finally:
            self._stack.close()

    def _begin(self) -> None:
        if not self._virtual:
            self._stack.callback(sys.setswitchinterval, sys.getswitchinterval())
            sys.setswitchinterval(SWITCH_INTERVAL)
            self._thread = threading.Thread(target=self._turn_all, name="teleop control", daemon=True)
            self._thread.start()
        self._until(lambda: self.program.running.is_set() or self.over)
        if self.over:
            raise DeviceError(self.reason)

    def _turn_all(self) -> None:
        self._loop.run()
        self._ended()

    def _ended(self) -> None:
        self.program.running.set()
        result = self._loop.supervisor.result
        self.program.end(DeviceError(self.reason or ("done" if result is Result.DONE else "the run has ended")))

    def _until(self, condition: Callable[[], bool]) -> None:
        """Wait for `condition`: on the virtual clock by turning the loop, else for what the control thread sets."""
        if self._thread is None:
            with self._turning:
                while not condition() and not self.over:
                    self._loop.turn()
                if self.over:
                    self._ended()
            return
        waiting = self.program.wait if self.program.running.is_set() else self.program.running.wait
        waiting()


def shortest_seconds(session: Session, targets: dict[Axis, float]) -> float:
    """The least time in which every axis can reach its target from rest where it is now."""
    from teleop.planner.rest_to_rest import ease

    tick = session.program.tick
    if tick is None:
        return math.nan
    here = {axis: tick.motion[axis] for axis in targets}
    return ease(here, targets, session.profile.limits, 1.0).duration
