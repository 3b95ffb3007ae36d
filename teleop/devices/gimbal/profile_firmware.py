"""The firmware that an in-process `sim:` gimbal simulates, so that a rehearsal agrees with the profile's signs."""

from __future__ import annotations

from collections.abc import Callable

from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware


def profile_firmware(profile: Profile, link: str) -> Firmware:
    """The firmware with the `speed_signs` and `report_signs` of the gimbal sections on `link`.

    The simulated gimbal counts positions as `core.axes` does. Its other signs are therefore those of the profile
    relative to the profile's `signs`: 1 where speeds or reports count as positions do.
    """
    sections = [section for section in profile.sinks if isinstance(section, GimbalSection) and section.link == link]
    if not any(section.speed_signs or section.report_signs for section in sections):
        return DOCUMENTED
    return Firmware(
        speed_signs=_relative(sections, lambda section, axis: section.wiring.speed_sign(axis)),
        report_signs=_relative(sections, lambda section, axis: section.wiring.report_sign(axis)),
    )


def _relative(sections: list[GimbalSection], sign_of: Callable[[GimbalSection, Axis], int]) -> tuple[int, int, int]:
    """The signs of yaw, roll and pitch, relative to those of positions; 1 for an angle that no section drives."""
    signs = [1, 1, 1]
    for section in sections:
        for index, axis in enumerate(section.axes):
            if axis is not None:
                signs[index] = section.wiring.sign(axis) * sign_of(section, axis)
    yaw, roll, pitch = signs
    return yaw, roll, pitch
