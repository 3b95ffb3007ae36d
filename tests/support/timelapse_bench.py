"""A timelapse shot without a rig: the planner takes the axes, a book of the test keeps the frames, a camera answers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from at_once import AtOnce

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Exposure, ShutterResult, ShutterStep
from teleop.core.interfaces import Feedback
from teleop.core.timing import PERIOD
from teleop.planner.live import Live
from teleop.timelapse.compile import Timelapse, load_timelapse
from teleop.timelapse.go_motion import mover_of
from teleop.timelapse.journal import FrameState, Note
from teleop.timelapse.progress import Progress
from teleop.timelapse.source import TimelapseSource

LIMITS = {Axis.PAN: Limits(-180, 180, 120, 240, 1200)}
FILE = """\
fps: 24
keyframes:
- {at: 0, pan: 0}
- {at: FRAMES, pan: 20}
timelapse: {frames: 5, interval: 4s, exposure: 0.5s, OPTIONS}
"""


class Book:
    """Notes of frames, on the disk as soon as `writes` says so; `trouble` makes it a journal that cannot be written."""

    def __init__(self) -> None:
        self.notes: list[Note] = []
        self.trouble = ""
        self.writes = True

    def note(self, frame: int | None, state: FrameState) -> Note:
        self.notes.append(Note(frame, state, safe=self.writes))
        return self.notes[-1]

    def finish(self) -> Note:
        return self.note(None, FrameState.DONE)

    def states(self, frame: int) -> list[FrameState]:
        return [note.state for note in self.notes if note.frame == frame]


def timelapse(folder: Path, options: str = "mode: shoot-move-shoot", frames: int = 4) -> Timelapse:
    """Five frames, four seconds apart, of a pan over `frames` of them."""
    (folder / "shoot.yaml").write_text(FILE.replace("OPTIONS", options).replace("FRAMES", str(frames)))
    found = load_timelapse(str(folder / "shoot.yaml"), LIMITS, "the rig")
    assert found is not None
    return found


class Shoot:
    """`answers` are the camera's return codes by frame, 0 where it is not named; None is silence."""

    def __init__(self, timelapse: Timelapse, answers: Mapping[int, int | None] | None = None, first: int = 0) -> None:
        self.timelapse, self.answers = timelapse, answers or {}
        self.mover = mover_of(timelapse, AtOnce())
        self.book = Book()
        self.progress = Progress(timelapse.slots, timelapse.fps, frame=first)
        self.source = TimelapseSource(timelapse, self.mover, self.book, first, self.progress)
        self.live = Live(timelapse.limits, PERIOD)
        self.live.reset(dict.fromkeys(timelapse.limits, State(0.0)))
        self.now, self.steps = 0.0, list[tuple[float, Exposure]]()
        self.source.start(self.now, self.live.motion)

    def run(self, seconds: float = math.inf) -> None:
        """Until it is over, or for some time."""
        end = self.now + min(seconds, 300.0)
        while self.now < end - PERIOD / 2:
            self.tick()
            if math.isinf(self.source.next_change(self.now - PERIOD)):
                return

    def tick(self) -> None:
        motion = self.live.motion
        readings = {axis: Reading(state.position, self.now - PERIOD) for axis, state in motion.items()}
        demand, events = self.source.read(self.now, Feedback(motion, readings))
        self.live.step(demand, 1)
        for event in events:
            assert isinstance(event, Exposure)
            self.steps.append((self.now, event))
            code = self.answers.get(event.frame, 0)
            if event.step is ShutterStep.PRESS:
                self.source.on_shutter_result(ShutterResult(event.frame, code))
        self.now = round(self.now + PERIOD, 6)

    def times(self, step: ShutterStep) -> dict[int, float]:
        """When this step of each frame was, relative to the slot of the first one; the last time where it was twice."""
        return {event.frame: round(time - self.source.begin, 6) for time, event in self.steps if event.step is step}
