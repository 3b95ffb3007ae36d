"""Readings of the gimbal's three angles, as they came."""

from __future__ import annotations

from typing import NamedTuple

ANGLES = "yaw", "roll", "pitch"


class Places(NamedTuple):
    """A reading: when it was asked for (s), and the three angles (deg) as they came, whatever their order."""

    time: float
    angles: tuple[float, float, float]
    pushed: bool = False


def around(angle: float) -> float:
    """The same direction within half a turn."""
    return angle - 360 * round(angle / 360) if abs(angle) > 180 else angle


def gone(before: tuple[float, float, float], after: tuple[float, float, float]) -> tuple[float, float, float]:
    """How far (deg) each angle went."""
    yaw, roll, pitch = (around(end - start) for start, end in zip(before, after, strict=True))
    return yaw, roll, pitch
