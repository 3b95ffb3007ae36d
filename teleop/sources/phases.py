"""What a timelapse is doing, and how that may change, as one table: a pause is only in it between two frames."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto


class Phase(Enum):
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


class Event(Enum):
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


TRANSITIONS: Mapping[tuple[Phase, Event], Phase] = {
    (Phase.APPROACH, Event.ARRIVED): Phase.SETTLE,
    (Phase.SETTLE, Event.SETTLED): Phase.WAIT,
    (Phase.WAIT, Event.PAUSE): Phase.PAUSED,
    (Phase.PAUSED, Event.RESUME): Phase.WAIT,
    (Phase.WAIT, Event.DUE): Phase.PREFOCUS,
    (Phase.WAIT, Event.MISSED): Phase.WAIT,
    (Phase.WAIT, Event.LAST): Phase.FINISH,
    (Phase.PREFOCUS, Event.FIRE): Phase.EXPOSE,
    (Phase.PREFOCUS, Event.MISSED): Phase.WAIT,
    (Phase.PREFOCUS, Event.LAST): Phase.FINISH,
    (Phase.EXPOSE, Event.EXPOSED): Phase.POST,
    (Phase.POST, Event.STEP): Phase.MOVE,
    (Phase.POST, Event.STAY): Phase.WAIT,
    (Phase.POST, Event.MISSED): Phase.WAIT,
    (Phase.POST, Event.LAST): Phase.FINISH,
    (Phase.MOVE, Event.ARRIVED): Phase.SETTLE,
    (Phase.FINISH, Event.WRITTEN): Phase.OVER,
    # A frame whose shutter was pressed is seen to its end; all else stops at once, and begins again with the approach.
    **{
        (phase, Event.STOP): Phase.STOPPED
        for phase in (Phase.APPROACH, Phase.SETTLE, Phase.WAIT, Phase.PAUSED, Phase.PREFOCUS, Phase.POST, Phase.MOVE)
    },
    (Phase.STOPPED, Event.RESTART): Phase.APPROACH,
}
