"""What takes the camera from frame to frame of a timelapse: in steps between the shots, or gliding through them.

`go_motion` has the third, which rests between the shots and moves through each. All keep the shoot's own time, in which
frame N is due at a time that a formula gives: for steps it is the clock's, shifted; for a glide it is the move's,
because there the place of a frame is a moment of the move. All begin by coming from the side that the move comes from,
so that play in the gears is taken up the same way after a pause or a power cut.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import Protocol

from teleop.core.axes import Axis, Motion
from teleop.core.timing import SAME_TIME
from teleop.planner.rest_to_rest import rest_to_rest
from teleop.sequence.playback import Playback
from teleop.timelapse.budget import STEP_SHARE
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.way import GENTLE, Way, approach

FAR = 1000.0  # s: when any run-up is long over


class Mover(Protocol):
    """Times named `now` are the loop's clock, those named `time` the shoot's own, both in s."""

    @property
    def arrival(self) -> float:
        """When the way that it is on is over."""
        ...

    @property
    def run_up(self) -> float:
        """How long it moves, once begun, before it is at the frame that it approached, in s."""
        ...

    @property
    def ramp(self) -> float:
        """How long before each frame is due it leaves the place where it waits for it, in s."""
        ...

    @property
    def meets_slot(self) -> bool:
        """Whether it is on its way, or will be, so that the present frame can be shot when it is due."""
        ...

    def approach(self, now: float, motion: Motion, frame: int) -> None:
        """Set out for where `frame` begins, from rest at `motion`."""
        ...

    def begin(self, slot: float, time: float) -> None:
        """The shoot's own time is to be `time` at `slot`."""
        ...

    def at(self, now: float) -> Motion: ...

    def foreseen(self, time: float) -> Motion:
        """Where the axes will be at a `time` soon, on the loop's clock, as things are."""
        ...

    def step(self, now: float, frame: int, spare: float) -> bool:
        """Set out for `frame`, in `spare` s if that can be; False for what needs no step."""
        ...

    def next_motion(self, now: float) -> float:
        """`now` while it moves, later when it is about to, inf when it will not by itself."""
        ...

    def time(self, now: float) -> float: ...

    def when(self, time: float, now: float) -> float: ...

    def skip(self, now: float, seconds: float) -> int:
        """Wait so much longer for the present frame, as often as it takes: how often. 0: its place has been passed."""
        ...

    def pause(self, now: float) -> None: ...

    def resume(self, now: float, time: float, lead: float) -> None:
        """Go on: `time` is that of the frame that is next, and is `lead` s away or more."""
        ...


class StepMover:
    """Shoot-move-shoot: rests at each frame, and moves only between two shots."""

    run_up, ramp, meets_slot = 0.0, 0.0, True

    def __init__(self, timelapse: Timelapse) -> None:
        self._limits, self._positions = timelapse.limits, timelapse.path.positions(timelapse.frames)
        self._way = Way(0.0, {})
        self._base = math.inf  # when the shoot's own time is 0

    @property
    def arrival(self) -> float:
        return self._way.arrival

    def approach(self, now: float, motion: Motion, frame: int) -> None:
        place = self._place(frame)
        self._way = approach(now, motion, place, self._positions, frame, self._limits)

    def begin(self, slot: float, time: float) -> None:
        self._base = slot - time

    def at(self, now: float) -> Motion:
        return self._way.at(now)

    def foreseen(self, time: float) -> Motion:
        return self._way.at(time)

    def step(self, now: float, frame: int, spare: float) -> bool:
        place = self._place(frame)
        here = self._way.at(now)
        if all(here[axis].position == position for axis, position in place.items()):
            return False
        self._way = Way(now, here)
        gentle = rest_to_rest(here, place, self._limits, GENTLE).duration
        self._way.on(place, self._limits, STEP_SHARE, min(gentle, spare))
        return True

    def next_motion(self, now: float) -> float:
        return now if now < self.arrival - SAME_TIME else math.inf

    def time(self, now: float) -> float:
        return now - self._base

    def when(self, time: float, now: float) -> float:  # noqa: ARG002 - it keeps the clock's pace
        return self._base + time

    def skip(self, now: float, seconds: float) -> int:  # noqa: ARG002 - it rests at its place
        self._base += seconds
        return 1

    def pause(self, now: float) -> None: ...

    def resume(self, now: float, time: float, lead: float) -> None:
        self._base = max(self._base, now + lead - time)

    def _place(self, frame: int) -> Mapping[Axis, float]:
        return {axis: float(positions[frame]) for axis, positions in self._positions.items()}


class GlideMover:
    """Continuous: moves through the shots. A pause slows it down to rest along its path, and nothing is due meanwhile.

    Changes of speed are searched for by `executor`, a thread unless given.
    """

    ramp, meets_slot = 0.0, True

    def __init__(self, timelapse: Timelapse, executor: Executor | None = None) -> None:
        self._limits, self._slots, self._executor = timelapse.limits, timelapse.slots, executor
        self._move = timelapse.path.on(timelapse.slots)
        self._positions = timelapse.path.positions(timelapse.frames)
        self._playback = Playback(self._move, self._limits, executor=executor)
        self._way = Way(0.0, {})
        self._begin = math.inf
        self.run_up = 0.0

    @property
    def arrival(self) -> float:
        return self._way.arrival

    def approach(self, now: float, motion: Motion, frame: int) -> None:
        time = self._slots.at(frame)
        self._playback = Playback(self._move, self._limits, executor=self._executor, start_at=time)
        self._playback.begin(0.0)
        self.run_up = FAR - (self._playback.time(FAR) - time)
        place = {axis: state.position for axis, state in self._move.at(self._playback.opening).items()}
        self._way = approach(now, motion, place, self._positions, frame, self._limits)

    def begin(self, slot: float, time: float) -> None:  # noqa: ARG002 - it was approached
        self._begin = slot - self.run_up
        self._playback.begin(self._begin)

    def at(self, now: float) -> Motion:
        return self._way.at(now) if now < self._begin - SAME_TIME else self._playback.at(now)[1]

    def foreseen(self, time: float) -> Motion:
        return self._way.at(time) if time < self._begin - SAME_TIME else self._playback.foreseen(time)

    def step(self, now: float, frame: int, spare: float) -> bool:  # noqa: ARG002 - it is on its way
        return False

    def next_motion(self, now: float) -> float:
        if now < self._begin - SAME_TIME:
            return now if now < self.arrival - SAME_TIME else self._begin
        if self._playback.changing(now):
            return now
        return self._playback.when(self._move.next_motion(self._playback.time(now)), now)

    def time(self, now: float) -> float:
        """Before it moves, its time runs as the clock does, so that the prefocus of the first frame begins in time."""
        if now < self._begin - SAME_TIME:
            return self._playback.opening - (self._begin - now)
        return self._playback.time(now)

    def when(self, time: float, now: float) -> float:
        if now < self._begin - SAME_TIME and time <= self._playback.opening:
            return self._begin - (self._playback.opening - time)
        return self._playback.when(time, max(now, self._begin))

    def skip(self, now: float, seconds: float) -> int:  # noqa: ARG002 - the place of the frame is behind
        return 0

    def pause(self, now: float) -> None:
        if now < self._begin - SAME_TIME:
            self._begin = math.inf
        else:
            self._playback.pause(now)

    def resume(self, now: float, time: float, lead: float) -> None:
        if math.isinf(self._begin):
            self.begin(now + lead + self.run_up, time)
        else:
            self._playback.resume(now)
