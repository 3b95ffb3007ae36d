"""How far a shoot is, and everything that did not go as it should, counted. One value over all its runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from teleop.timelapse.schedule import Schedule


@dataclass
class Progress:
    """`shot` is how many frames are in the camera, the frames of an earlier process included.

    `missed` are slots that passed without a picture, `lost` the frames that have none for it, `doubtful` those that
    may be missing, `stopped` those that were exposing when a STOP halted axes that moved. `late` is how many were shot
    after their slot's tick, `latest` by how much at most, in s. `refused` is how often the camera would not,
    `unsettled` how many frames were shot before the axes were measured to be still.
    """

    slots: Schedule
    fps: float | None
    shot: int = 0
    missed: int = 0
    lost: list[int] = field(default_factory=list)
    doubtful: list[int] = field(default_factory=list)
    stopped: list[int] = field(default_factory=list)
    late: int = 0
    latest: float = 0.0
    refused: int = 0
    unsettled: int = 0
    frame: int = 0  # that is next, or being shot
    due: float = math.inf  # when that is, on the loop's clock
    phase: str = "approach"
    pausing: bool = False
    problem: str = ""  # why it is paused, where nobody asked for it
    by_hand: bool = False  # an operator shoots each frame: nothing is due

    def left(self, now: float) -> float:
        """Seconds until the last frame."""
        return max(0.0, self.due - now) + self.slots.at(self.slots.frames - 1) - self.slots.at(self.frame)

    @property
    def clip(self) -> float | None:
        """Seconds of clip so far; None where its speed is not known."""
        return self.shot / self.fps if self.fps else None

    @property
    def troubles(self) -> Mapping[str, int]:
        """What should be 0, by name."""
        return {
            "missed slots": self.missed,
            "lost frames": len(self.lost),
            "doubtful": len(self.doubtful),
            "late": self.late,
            "refused": self.refused,
            "unsettled": self.unsettled,
        }
