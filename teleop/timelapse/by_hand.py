"""Single frames for an animator: an operator goes from frame to frame and shoots each when the scene is ready.

There are no slots. The shutter waits for the journal as in a shoot by the clock, and with blur the axes move through
the exposure in the same way. A frame that is shot again replaces its earlier picture, and asks nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from enum import Enum, auto

from teleop.core.axes import Motion
from teleop.core.errors import Interrupted
from teleop.core.events import ShutterResult, SourceEvent, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command, Input
from teleop.core.setpoints import Demand, StateTarget
from teleop.core.timing import SAME_TIME, whole_ticks
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.frame_log import FrameBook, FrameLog
from teleop.timelapse.frame_shutter import FrameShutter
from teleop.timelapse.journal import FrameState
from teleop.timelapse.movers import Mover
from teleop.timelapse.progress import Progress

KEYS_PERIOD = 0.05  # s between two looks at the keys while nothing else happens


class Step(Enum):
    """What is done with the present frame."""

    MOVE = auto()  # to it, and until it has settled
    READY = auto()  # for the operator
    NOTE = auto()  # until the journal is on the disk
    RUN = auto()  # until the shutter is due
    EXPOSE = auto()
    ANSWER = auto()  # until the camera has answered
    HALTED = auto()
    FINISH = auto()  # until the journal says so
    OVER = auto()


WORDS = {Step.MOVE: "moving", Step.READY: "ready", Step.HALTED: "stopped", Step.FINISH: "finishing", Step.OVER: "over"}


class ByHandSource:
    """From frame `first` on. `shot` are the frames that the journal has; what is shot here is added to it."""

    resumable = quits = True
    pauses = False

    def __init__(
        self,
        timelapse: Timelapse,
        mover: Mover,
        book: FrameBook,
        first: int,
        progress: Progress,
        keys: Input | None,
        shot: set[int],
    ) -> None:
        self._timelapse, self._mover, self._book, self._keys = timelapse, mover, book, keys
        self.progress, self.shot, self.begin = progress, shot, math.inf
        self._log = FrameLog(book, progress, timelapse.go_on)
        self._shutter = FrameShutter(timelapse.phases, self._log)
        self.frame = self._wanted = first
        self.step, self._slot, self._ended = Step.MOVE, math.inf, -math.inf
        self._halted = False
        self._on_due: Mapping[Step, Callable[[float], None]] = {
            Step.MOVE: self._move,
            Step.READY: self._ready,
            Step.NOTE: self._note,
            Step.RUN: self._run,
            Step.EXPOSE: self._expose,
            Step.ANSWER: self._answer,
            Step.FINISH: self._finish,
        }

    def start(self, now: float, motion: Motion) -> None:
        self._mover.approach(now, motion, self.frame)
        self.begin = self._mover.arrival

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:  # noqa: ARG002 - not asked
        self._check_keys(now)
        self._advance(now)
        demand = {axis: StateTarget(*state) for axis, state in self._mover.at(now).items()}
        return demand, self._shutter.take_events()

    def next_change(self, now: float) -> float:
        if self.step is Step.OVER:
            return math.inf
        if self.step is Step.READY:
            return max(now, min(self._mover.next_motion(now), now + KEYS_PERIOD))
        return now

    @property
    def busy(self) -> bool:
        """While the axes are halted: whether a picture is being taken."""
        return self._halted and self.step in (Step.EXPOSE, Step.ANSWER)

    def pause(self, now: float) -> bool | None:  # noqa: ARG002 - it waits for the operator anyway
        return False

    def suspend(self, now: float) -> None:
        """No shutter is pressed from `now` on. A frame that was begun and not pressed is as it was before."""
        self._halted = True
        if self.step is Step.EXPOSE and self._mover.next_motion(now) < self._shutter.exposed_at:
            self.progress.stopped.append(self.frame)
        if self.step in (Step.NOTE, Step.RUN):
            self._give_up()
        if self.step in (Step.MOVE, Step.READY, Step.NOTE, Step.RUN):
            self.step = Step.HALTED
            self._tell()

    def linger(self, now: float) -> Sequence[TickEvent]:
        """What ends the frame whose shutter was pressed before the axes were halted."""
        self._advance(now)
        return self._shutter.take_events()

    def resume(self, now: float, motion: Motion) -> None:
        """To the present frame again, from rest at `motion`."""
        self._halted = False
        if self.step is not Step.OVER:
            self._approach(now, motion, self._wanted)

    def on_shutter_result(self, result: ShutterResult) -> None:
        """Take the camera's answer to a press; it is written down at once."""
        self._shutter.on_result(result)

    def leave(self) -> None:
        """End the run: a frame that was begun and whose shutter was not pressed is as it was before."""
        if self.step in (Step.NOTE, Step.RUN):
            self._give_up()

    def due_at(self, frame: int, now: float) -> float:  # noqa: ARG002 - as a shoot by the clock has it
        """Nothing is due."""
        return -math.inf

    def _advance(self, now: float) -> None:
        before = None
        while self.step is not before and self.step in self._on_due:
            before = self.step
            self._on_due[self.step](now)
        self._tell()

    def _tell(self) -> None:
        words = WORDS.get(self.step, "shooting")
        state = "shot" if self.frame in self.shot else "not shot"
        self.progress.frame, self.progress.shot = self.frame, len(self.shot)
        self.progress.phase = f"frame {self.frame} of {self._timelapse.frames}, {state}: {words}"

    def _approach(self, now: float, motion: Motion, frame: int) -> None:
        self.frame = self._wanted = frame
        self._mover.approach(now, motion, frame)
        self.step = Step.MOVE

    def _move(self, now: float) -> None:
        if now >= max(self._mover.arrival, self._ended) + self._timelapse.phases.settle - SAME_TIME:
            self.step = Step.READY

    def _ready(self, now: float) -> None:
        if self._wanted == self.frame:
            return
        if self._wanted < self.frame:
            self._approach(now, self._mover.at(now), self._wanted)
            return
        self.frame, self.step = self._wanted, Step.MOVE
        self._mover.step(now, self.frame, math.inf)
        self._mover.pause(now)

    def _shoot(self, now: float) -> None:
        self.progress.problem = ""
        self._shutter.begin(self.frame, now)
        self.step = Step.NOTE

    def _note(self, now: float) -> None:
        """Once it is on the disk and the camera has focused, the axes may set out."""
        if self._shutter.is_unwritten:
            self._give_up()
            self.step, self.progress.problem = Step.READY, "the journal could not be written: press Enter again"
        elif self._shutter.ready(now):
            self._slot = whole_ticks(now + self._mover.ramp)
            self._mover.begin(self._slot, self._timelapse.slots.at(self.frame))
            self.step = Step.RUN

    def _run(self, now: float) -> None:
        if now >= self._slot - SAME_TIME:
            self._shutter.press(now)
            self.step = Step.EXPOSE

    def _expose(self, now: float) -> None:
        if now >= self._shutter.exposed_at - SAME_TIME:
            self._ended = self._shutter.exposed_at + self._mover.ramp
            self._shutter.release()
            self.step = Step.ANSWER

    def _answer(self, now: float) -> None:
        if not self._halted and now < self._ended - SAME_TIME:
            return
        result = self._shutter.result(now)
        if result is None:
            return
        past = self._log.is_past(result)
        (self.shot.add if past else self.shot.discard)(self.frame)
        if past and self.frame < self._timelapse.frames - 1:
            self._wanted = self.frame + 1
        if self._halted:
            self.step = Step.HALTED
        elif self._wanted == self.frame and self._mover.ramp:
            self._approach(now, self._mover.at(now), self.frame)
        else:
            self.step = Step.READY

    def _give_up(self) -> None:
        """Also when an earlier picture of it is there: that one counts."""
        self._shutter.give_up()
        if self.frame in self.shot:
            self._book.note(self.frame, FrameState.DONE)

    def _finish(self, now: float) -> None:
        if self._log.finished(now):
            self.step = Step.OVER

    def _check_keys(self, now: float) -> None:
        for press in self._keys.read(now).presses if self._keys is not None else ():
            if press.command is Command.QUIT:
                self._quit()
            elif self.step not in (Step.MOVE, Step.READY):
                continue  # one picture at a time, and the frame that is shot is not changed
            elif press.command is Command.NEXT:
                self._wanted = min(self._wanted + 1, self._timelapse.frames - 1)
            elif press.command is Command.PREVIOUS:
                self._wanted = max(self._wanted - 1, 0)
            elif press.command is Command.GO and self.step is Step.READY and self._wanted == self.frame:
                self._shoot(now)

    def _quit(self) -> None:
        """Raises Interrupted unless every frame has been shot."""
        if len(self.shot) < self._timelapse.frames or self.step not in (Step.MOVE, Step.READY):
            raise Interrupted("q pressed")
        self.step = Step.FINISH
