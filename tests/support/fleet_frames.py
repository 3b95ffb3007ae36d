"""When the gimbals of several rigs began to move, by the frames on their buses, whose times are by one clock."""

from __future__ import annotations

from collections.abc import Sequence

STILL = 0.05  # deg: half of what a frame can tell apart
PERIOD = 0.02  # s between two frames of a sink
END = 29.0  # deg: the pan of a move to 30 rises up to here

Pans = Sequence[tuple[float, float]]
"""When each position was commanded (s, monotonic), and which pan (deg)."""


def first_moving(pans: Pans) -> float:
    """When the first frame came whose pan is another than that of rest."""
    return next(time for time, pan in pans if abs(pan) > STILL)


def began(buses: Sequence[Pans]) -> list[float]:
    """When each gimbal began a rising pan that all share (s, monotonic), by the frame that was quickest on its way.

    All rigs send the same pans, 20 ms apart, so a pan tells how long after the start it was sent. A frame is late on a
    busy computer, and never early: the earliest start that one of them tells is the one that is right.
    """
    rising = [[(time, pan) for time, pan in pans if STILL < pan < END] for pans in buses]
    order = {pan: number for number, pan in enumerate(dict.fromkeys(pan for _, pan in max(rising, key=len)))}
    return [min(time - order[pan] * PERIOD for time, pan in way if pan in order) for way in rising]
