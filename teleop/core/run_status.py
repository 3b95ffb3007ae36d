"""What a view shows of a run that moves by itself: a sequence, a timelapse, a calibration move.

A source makes a new one whenever it is asked, in the control thread; a view may then read it from any thread. Whoever
controls the source (`Conductor`) adds what it knows with `dataclasses.replace`: `stop`, `paused`, `note` and `hints`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from teleop.core.axes import Motion, moves

StopState = Literal["", "stopping", "stopped"]


class NextKey(NamedTuple):
    """A keyframe that comes: its number, from 1, and when it is, in s of the move."""

    number: int
    at: float


class NextCue(NamedTuple):
    """A cue that comes: when it is, in s of the move, and what it does, in a few words."""

    at: float
    what: str


class Hint(NamedTuple):
    """A key that does something now, and what, for the line at the bottom of a view; the most important come first."""

    key: str
    does: str


@dataclass(frozen=True, slots=True)
class RunStatus:
    """A run at one moment. Times are in s.

    `phase` is what it does, in a few words. `elapsed` is the move's own time, None before it begins, `duration` the
    move's length (inf for none), `left` how long until its end at the present speed, None where that is not known.
    `speed` is the share of the written speed. `total` names what is counted where that is not seconds: a shoot's
    frames, as "12 of 720 frames", with `done` the share of it.

    `stop` is a latched STOP: "stopping" while an axis still moves, then "stopped" (see `stop_state`). `recording` is
    the camera's last command, None for none. `note` is a line for the operator, `question` one that waits for an
    answer. `number` is that of the pass, from 1, and `passes` how many there are, inf for until it is stopped.
    """

    phase: str
    elapsed: float | None = None
    duration: float = math.inf
    left: float | None = None
    key: NextKey | None = None
    cue: NextCue | None = None
    speed: float = 1.0
    stop: StopState = ""
    paused: bool = False
    recording: bool | None = None
    note: str = ""
    question: str = ""
    number: int = 1
    passes: float = 1
    total: str = ""
    done: float | None = None
    hints: Sequence[Hint] = ()


def stop_state(latched: bool, motion: Motion) -> StopState:
    """What a view says of a latched STOP while the axes are commanded to move like this."""
    if not latched:
        return ""
    return "stopping" if moves(motion) else "stopped"
