"""Trims a sequence that plays: an operator's inputs add an offset to it, axis by axis, live.

For the inputs an offset is an axis like any other: its limits are what the sequence leaves of the rig's
(`planner.offset_limits`), its 0 is the sequence itself, and all that holds for an input of `teleop live` (centered
first, stale is rest, jogs, sliders, speed ranges) holds here, by the same code. So the sum is always legal. An offset
that no input moves is held; to release it is a recall of 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from teleop.config.operator_settings import SticksSection
from teleop.core.axes import Axis, Limits, State
from teleop.core.operator_input import Input, Press
from teleop.core.timing import PERIOD
from teleop.manual.arbitration import Arbitration
from teleop.manual.interlock import Interlock
from teleop.manual.recall import Recall, at_rest
from teleop.manual.status import Message, MessageLog
from teleop.planner.live import Live
from teleop.planner.offset_limits import trimmed

RELEASE = 2.0  # s in which an offset goes back to 0, or as soon as its limits allow


class LiveOffset:
    """`inputs` in the order of their priority; `limits` are those of the offsets.

    `offsets` are where they are now, `messages` what the operator has to know, newest first.
    """

    def __init__(self, limits: Mapping[Axis, Limits], inputs: Sequence[Input], sticks: SticksSection) -> None:
        self._locks = [Interlock(device) for device in inputs]
        self._limits = limits
        self._sticks, self._range = sticks, sticks.start_range - 1
        self._log, self._now = MessageLog(), 0.0
        self._arbitration = Arbitration(limits, self._locks, sticks, self.notify)
        self._live = Live(limits, PERIOD)
        self._live.reset(dict.fromkeys(limits, State(0.0)))
        self.offsets: dict[Axis, State] = self._live.motion

    @property
    def messages(self) -> Sequence[Message]:
        return self._log.messages

    @property
    def share(self) -> float:
        """What full deflection is of an offset's velocity, as things are."""
        return self._sticks.speed * self._sticks.ranges[self._range]

    def notify(self, text: str) -> None:
        self._log.notify(self._now, text)

    def read(self, now: float) -> list[tuple[str, Press]]:
        """What was pressed, with the name of each input; what the inputs hold is kept for `step`."""
        presses = [(lock.name, press) for lock in self._locks for press in lock.read(now, True).presses]
        seconds, self._now = now - self._now, now
        self._seconds = max(seconds, PERIOD)
        notes = [note for lock in self._locks for note in lock.held.notes]
        for text in (*self._log.changes(self._locks, self._arbitration.drivers), *notes):
            self.notify(text)
        return presses

    def step(self, motion: Mapping[Axis, State], allowed: bool) -> dict[Axis, State]:
        """`motion` with the offsets, of the tick that was read; where nothing is `allowed` these come to rest."""
        if not allowed:
            self._arbitration.drop_all()
        # After a rest one tick is enough, as it is for the loop; else as many as have gone by.
        ticks = 1 if self._live.at_rest else round(self._seconds / PERIOD)
        setpoints = self._arbitration.setpoints(self._now, self._seconds, self.offsets, self.share)
        self.offsets = self._live.step(setpoints if allowed else {}, ticks)
        return trimmed(motion, self.offsets)

    def halt(self) -> None:
        """The axes are stopped, offsets and all: every offset is where its own fastest stop would end, at rest.

        What the inputs had asked for is over, and each must be centered again.
        """
        self._arbitration.drop_all()
        for lock in self._locks:
            lock.relock()
        self._live.reset({axis: at_rest(state, self._limits[axis]) for axis, state in self.offsets.items()})
        self.offsets = self._live.motion

    def release(self, name: str) -> None:
        """Take every offset back to 0, as this input asks; a stick ends that."""
        lock = next(lock for lock in self._locks if lock.name == name)
        if lock.waits_for:
            self.notify(f"trim unchanged: {name} is locked: {lock.waits_for}")
        elif any(state.position for state in self.offsets.values()):
            self._arbitration.begin(Recall("trim to 0", lock, dict.fromkeys(self.offsets, 0.0), self._now, RELEASE))

    def change_range(self, by: int, around: bool = False) -> None:
        """To a slower or faster range; `around`: after the fastest comes the slowest."""
        ranges, index = self._sticks.ranges, self._range + by
        self._range = index % len(ranges) if around else min(max(index, 0), len(ranges) - 1)
        self.notify(f"trim speed {ranges[self._range]:.0%}")
