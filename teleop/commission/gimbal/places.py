"""Readings of the gimbal's three angles, as they came."""

from __future__ import annotations

from typing import NamedTuple

from teleop.config.wiring import half_turn

ANGLES = "yaw", "roll", "pitch"


class Places(NamedTuple):
    """A reading: when it was asked for (s), and the three angles (deg) as they came, whatever their order."""

    time: float
    angles: tuple[float, float, float]
    pushed: bool = False


def gone(before: tuple[float, float, float], after: tuple[float, float, float]) -> tuple[float, float, float]:
    """How far (deg) each angle went."""
    yaw, roll, pitch = (half_turn(end - start) for start, end in zip(before, after, strict=True))
    return yaw, roll, pitch
