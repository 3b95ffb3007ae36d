"""The firmware that an in-process `sim:` gimbal simulates, so that a rehearsal agrees with the profile's signs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.devices.gimbal.profile_simulation import position_signs, sections_on, simulated_firmware
from teleop.sim.gimbal.firmware import Firmware


def profile_firmware(profile: Profile, link: str) -> Firmware:
    """The firmware that the profile simulates, with the `speed_signs` and `report_signs` of the sections on `link`.

    The simulated gimbal counts positions as `core.axes` does, unless `simulated` has `signs`. Its other signs are
    therefore those of the profile relative to the profile's `signs`: 1 where speeds or reports count as positions do.
    """
    sections, made = sections_on(profile, link), simulated_firmware(profile, link)
    if not any(section.speed_signs or section.report_signs for section in sections):
        return made
    speeds = _relative(sections, lambda section, axis: section.wiring.speed_sign(axis))
    reports = _relative(sections, lambda section, axis: section.wiring.report_sign(axis))
    return replace(made, speed_signs=made.speed_signs or speeds, report_signs=made.report_signs or reports)


def _relative(sections: list[GimbalSection], sign_of: Callable[[GimbalSection, Axis], int]) -> tuple[int, int, int]:
    """The signs of yaw, roll and pitch, relative to those of positions; 1 for an angle that no section drives."""
    signs = [1, 1, 1]
    for section in sections:
        for index, axis in enumerate(section.axes):
            if axis is not None:
                counted = position_signs(section)[index]
                signs[index] = counted * section.wiring.sign(axis) * sign_of(section, axis)
    yaw, roll, pitch = signs
    return yaw, roll, pitch
