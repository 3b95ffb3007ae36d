"""Takes one frame: written down, focused, pressed, released, and what the camera answered.

Nothing here waits: the journal writes in a thread of its own, and the camera's answer comes by `on_result`; each tick
asks whether they have come.
"""

from __future__ import annotations

import math

from teleop.core.events import Exposure, ShutterResult, ShutterStep, TickEvent
from teleop.core.timing import SAME_TIME
from teleop.timelapse.budget import Phases
from teleop.timelapse.frame_log import FrameLog
from teleop.timelapse.journal import Note

ANSWER_TIMEOUT = 0.7  # s after which a camera counts as silent: a lost link has been found out by then


class FrameShutter:
    """`phases` says how long each step takes, in s."""

    def __init__(self, phases: Phases, log: FrameLog) -> None:
        self._phases, self._log = phases, log
        self._events: list[TickEvent] = []
        self.pressed = math.inf  # s: when the shutter was
        self._frame = -1
        self.focus_at, self._focus_end = math.inf, math.inf  # s: inf: not asked for, or asked for already
        self._note: Note | None = None
        self._result: ShutterResult | None = None

    def take_events(self) -> list[TickEvent]:
        """What the camera is to do now, each once."""
        events, self._events = self._events, []
        return events

    def begin(self, frame: int, now: float, focus_at: float = -math.inf) -> None:
        """Write the frame down, and let the camera focus, at once or from `focus_at` on, in s.

        Raises TeleopError when nothing can be written down.
        """
        self._frame, self._focus_end = frame, max(now, focus_at) + self._phases.prefocus
        self._note = self._log.begin(frame)
        self.focus_at = focus_at if self._phases.prefocus else math.inf
        self._focus(now)

    @property
    def noted(self) -> bool:
        """Whether the frame is on the disk."""
        return self._note is not None and self._note.safe

    @property
    def is_unwritten(self) -> bool:
        """Whether writing the frame down has failed, for the time being. Raises TeleopError where it is for good."""
        self._log.check(self._frame)
        return self._note is not None and self._note.failed

    def ready(self, now: float) -> bool:
        """Whether the shutter may be pressed. Raises TeleopError when nothing can be written down."""
        self._log.check(self._frame)
        self._focus(now)
        return self.noted and now >= self._focus_end - SAME_TIME

    def _focus(self, now: float) -> None:
        if now >= self.focus_at - SAME_TIME:
            self._events.append(Exposure(self._frame, ShutterStep.FOCUS))
            self.focus_at = math.inf

    def press(self, now: float) -> None:
        self._events.append(Exposure(self._frame, ShutterStep.PRESS))
        self.pressed, self._result = now, None

    def release(self) -> None:
        self._events.append(Exposure(self._frame, ShutterStep.RELEASE))

    def give_up(self) -> None:
        """The frame was begun, and its shutter is not pressed: it counts as not begun, and its focus is released."""
        self._log.unshot(self._frame)
        if self._phases.prefocus and math.isinf(self.focus_at):
            self.release()
        self.focus_at = math.inf

    def on_result(self, result: ShutterResult) -> None:
        """Keep the camera's answer to the press; a picture is written down at once."""
        if result.frame == self._frame and self.pressed < math.inf:
            self._result = result
            self._log.on_result(result)

    @property
    def exposed_at(self) -> float:
        """When the exposure ends, in s."""
        return self.pressed + self._phases.exposure

    @property
    def done_at(self) -> float:
        """When the axes may move again, once the camera has answered, in s."""
        return self.exposed_at + self._phases.post

    @property
    def answered(self) -> bool:
        return self._result is not None

    def result(self, now: float) -> ShutterResult | None:
        """The camera's answer, once, when the frame is done; None until then."""
        result = self._result
        if result is None or now < self.done_at - SAME_TIME:
            return None
        if result.code is None and now < self.pressed + ANSWER_TIMEOUT:
            return None
        self.pressed, self._result = math.inf, None
        return result
