"""Which axes of which gimbal a calibration measures."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.core.errors import UsageError


def measured_axes(profile: Profile, axis: str | None) -> tuple[GimbalSection, Sequence[Axis]]:
    """The gimbal, and which of its axes to measure. Raises UsageError where there is none."""
    for section in profile.sinks:
        if isinstance(section, GimbalSection):
            axes = [each for each in section.axes if each in profile.limits and axis in (None, each)]
            if axes:
                return section, [each for each in axes if each is not None]
    raise UsageError(
        f"--axis {axis}: no gimbal of {profile.name} moves it" if axis else f"{profile.name} has no gimbal"
    )
