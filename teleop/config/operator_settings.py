"""How a rig answers to its operator: the profile's `sticks` and `presets`.

Recorded sticks keep the shape they were recorded with, so for them a dead zone or an expo that is not written is none;
a stick in use needs both. A section therefore knows whether they were given.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, Field, model_validator

from teleop.config.documents.base_model import Section
from teleop.config.documents.json_types import Time
from teleop.config.quantities import seconds

DEAD_ZONE = 0.06  # of a stick in use, when the profile has none
EXPO = 0.4
RANGES = [0.1, 0.35, 1.0]  # slow, medium, fast

Share = Annotated[float, Field(gt=0, le=1)]


def _rising(ranges: list[float]) -> list[float]:
    if ranges != sorted(set(ranges)):
        raise ValueError(f"must rise, slowest first, not {', '.join(f'{share:g}' for share in ranges)}")
    return ranges


class SticksSection(Section):
    """How a deflection becomes a velocity."""

    dead_zone: Annotated[float, Field(ge=0, le=0.3)] | None = None
    """Share of the deflection around the center that counts as 0. Default 0.06; recorded sticks: none."""
    expo: Annotated[float, Field(ge=0, le=0.75)] | None = None
    """How much finer a stick is near its center, 0 to 0.75. Default 0.4; recorded sticks: none."""
    speed: Share = 1.0
    """Share of an axis's velocity that a full stick gives."""
    ranges: Annotated[list[Share], Field(min_length=1), AfterValidator(_rising)] = Field(default_factory=RANGES.copy)
    """Speed ranges of the speed button as shares of `speed`, slowest first."""
    start_range: Annotated[int, Field(ge=1)] = 1
    """The speed range to begin with, counted from 1."""
    ramp: Annotated[float, Field(ge=0, le=5)] = 0.3
    """Time from rest to full speed and back in s, where the axis's limits allow it."""
    low_pass: Annotated[float, Field(ge=0, le=1)] = 0.05
    """Time constant of the low-pass filter on deflections, in s."""

    @model_validator(mode="after")
    def _starts_in_range(self) -> SticksSection:
        if self.start_range > len(self.ranges):
            raise ValueError(f"start_range must be 1..{len(self.ranges)}, one of the ranges, not {self.start_range}")
        return self


def _positive_time(value: Any) -> float:
    time = seconds(value, None)
    if time <= 0:
        raise ValueError("must be positive")
    return time


class PresetsSection(Section):
    """How presets are recalled."""

    recall: Annotated[Time, AfterValidator(_positive_time)] = 3.0
    """Time that a recall takes: `3s`."""
