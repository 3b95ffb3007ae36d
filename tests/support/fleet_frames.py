"""When the gimbal of a rig began to move, by the frames on its bus: the far ends of all rigs are in the test's process,
so all frames have their times by one clock.
"""

from __future__ import annotations

from collections.abc import Sequence

from far_gimbal import FarGimbal

from teleop.dji.gimbal import messages as gimbal

STILL = 0.05  # deg: half of what a frame can tell apart
PERIOD = 0.02  # s between two frames of a sink
END = 29.0  # deg: the pan of a move to 30 rises up to here


def pans(far: FarGimbal) -> Sequence[tuple[float, float]]:
    """When each position was commanded (s, monotonic), and which pan (deg)."""
    return [(time, message.yaw) for time, message in far.heard_of(gimbal.Position)]


def first_moving(far: FarGimbal) -> float:
    """When the first frame came whose pan is another than that of rest."""
    return next(time for time, pan in pans(far) if abs(pan) > STILL)


def began(fars: Sequence[FarGimbal]) -> list[float]:
    """When each gimbal began a rising pan that all share (s, monotonic), by the frame that was quickest on its way.

    All rigs send the same pans, 20 ms apart, so a pan tells how long after the start it was sent. A frame is late on a
    busy computer, and never early: the earliest start that one of them tells is the one that is right.
    """
    rising = [[(time, pan) for time, pan in pans(far) if STILL < pan < END] for far in fars]
    order = {pan: number for number, pan in enumerate(dict.fromkeys(pan for _, pan in max(rising, key=len)))}
    return [min(time - order[pan] * PERIOD for time, pan in way if pan in order) for way in rising]
