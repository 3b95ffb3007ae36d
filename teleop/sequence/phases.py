"""What a sequence is doing, and how that may change, as one table."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto


class SequencePhase(Enum):
    EASING = auto()  # to where the move begins
    PREROLL = auto()
    ARMED = auto()  # until the trigger
    PLAYING = auto()
    REJOINING = auto()  # back to the path, after a STOP
    RETURNING = auto()  # back to one
    OVER = auto()


class PhaseEvent(Enum):
    ARRIVED = auto()
    ARM = auto()
    START = auto()
    NEXT_PASS = auto()
    BACK_TO_ONE = auto()
    END = auto()
    RESUME = auto()  # after a STOP: each ease begins again from where the axes rest


TRANSITIONS: Mapping[tuple[SequencePhase, PhaseEvent], SequencePhase] = {
    (SequencePhase.EASING, PhaseEvent.ARRIVED): SequencePhase.PREROLL,
    (SequencePhase.PREROLL, PhaseEvent.ARM): SequencePhase.ARMED,
    (SequencePhase.PREROLL, PhaseEvent.START): SequencePhase.PLAYING,
    (SequencePhase.ARMED, PhaseEvent.START): SequencePhase.PLAYING,
    (SequencePhase.PLAYING, PhaseEvent.NEXT_PASS): SequencePhase.EASING,
    (SequencePhase.PLAYING, PhaseEvent.BACK_TO_ONE): SequencePhase.RETURNING,
    (SequencePhase.PLAYING, PhaseEvent.END): SequencePhase.OVER,
    (SequencePhase.REJOINING, PhaseEvent.ARRIVED): SequencePhase.PLAYING,
    (SequencePhase.RETURNING, PhaseEvent.ARRIVED): SequencePhase.OVER,
    (SequencePhase.EASING, PhaseEvent.RESUME): SequencePhase.EASING,
    (SequencePhase.PREROLL, PhaseEvent.RESUME): SequencePhase.EASING,
    (SequencePhase.ARMED, PhaseEvent.RESUME): SequencePhase.EASING,
    (SequencePhase.PLAYING, PhaseEvent.RESUME): SequencePhase.REJOINING,
    (SequencePhase.REJOINING, PhaseEvent.RESUME): SequencePhase.REJOINING,
    (SequencePhase.RETURNING, PhaseEvent.RESUME): SequencePhase.RETURNING,
}

BEFORE_THE_MOVE = frozenset({SequencePhase.EASING, SequencePhase.PREROLL, SequencePhase.ARMED})
TIMED = frozenset({SequencePhase.EASING, SequencePhase.PREROLL, SequencePhase.REJOINING, SequencePhase.RETURNING})
"""Phases whose end is a time known when they begin."""
