"""What a timelapse is doing, and how that may change, as one table: a pause is only in it between two frames."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto


class TimelapsePhase(Enum):
    APPROACH = auto()  # to where the first frame is shot
    SETTLE = auto()
    WAIT = auto()  # for the slot
    PAUSED = auto()
    PREFOCUS = auto()  # and until the journal is on the disk
    EXPOSE = auto()
    POST = auto()  # and until the camera has answered
    MOVE = auto()
    FINISH = auto()  # until the journal says so
    STOPPED = auto()  # the axes are halted, and no frame has been begun
    OVER = auto()


class PhaseEvent(Enum):
    ARRIVED = auto()
    SETTLED = auto()
    PAUSE = auto()
    RESUME = auto()
    DUE = auto()
    MISSED = auto()
    FIRE = auto()
    EXPOSED = auto()
    STEP = auto()
    STAY = auto()
    LAST = auto()
    WRITTEN = auto()
    STOP = auto()
    RESTART = auto()


TRANSITIONS: Mapping[tuple[TimelapsePhase, PhaseEvent], TimelapsePhase] = {
    (TimelapsePhase.APPROACH, PhaseEvent.ARRIVED): TimelapsePhase.SETTLE,
    (TimelapsePhase.SETTLE, PhaseEvent.SETTLED): TimelapsePhase.WAIT,
    (TimelapsePhase.WAIT, PhaseEvent.PAUSE): TimelapsePhase.PAUSED,
    (TimelapsePhase.PAUSED, PhaseEvent.RESUME): TimelapsePhase.WAIT,
    (TimelapsePhase.WAIT, PhaseEvent.DUE): TimelapsePhase.PREFOCUS,
    (TimelapsePhase.WAIT, PhaseEvent.MISSED): TimelapsePhase.WAIT,
    (TimelapsePhase.WAIT, PhaseEvent.LAST): TimelapsePhase.FINISH,
    (TimelapsePhase.PREFOCUS, PhaseEvent.FIRE): TimelapsePhase.EXPOSE,
    (TimelapsePhase.PREFOCUS, PhaseEvent.MISSED): TimelapsePhase.WAIT,
    (TimelapsePhase.PREFOCUS, PhaseEvent.LAST): TimelapsePhase.FINISH,
    (TimelapsePhase.EXPOSE, PhaseEvent.EXPOSED): TimelapsePhase.POST,
    (TimelapsePhase.POST, PhaseEvent.STEP): TimelapsePhase.MOVE,
    (TimelapsePhase.POST, PhaseEvent.STAY): TimelapsePhase.WAIT,
    (TimelapsePhase.POST, PhaseEvent.MISSED): TimelapsePhase.WAIT,
    (TimelapsePhase.POST, PhaseEvent.LAST): TimelapsePhase.FINISH,
    (TimelapsePhase.MOVE, PhaseEvent.ARRIVED): TimelapsePhase.SETTLE,
    (TimelapsePhase.FINISH, PhaseEvent.WRITTEN): TimelapsePhase.OVER,
    # A frame whose shutter was pressed is seen to its end; all else stops at once, and begins again with the approach.
    **{
        (phase, PhaseEvent.STOP): TimelapsePhase.STOPPED
        for phase in (
            TimelapsePhase.APPROACH,
            TimelapsePhase.SETTLE,
            TimelapsePhase.WAIT,
            TimelapsePhase.PAUSED,
            TimelapsePhase.PREFOCUS,
            TimelapsePhase.POST,
            TimelapsePhase.MOVE,
        )
    },
    (TimelapsePhase.STOPPED, PhaseEvent.RESTART): TimelapsePhase.APPROACH,
}
