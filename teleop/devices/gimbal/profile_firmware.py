"""The gimbal of a `sim:` link: firmware with the signs of the profile, and the dynamics that the profile gives it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from teleop.config.profile import Profile
from teleop.config.simulated_section import SimulatedSection
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import half_turn
from teleop.core.axes import Axis
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware


def profile_gimbal(profile: Profile, link: str) -> dict[str, Any]:
    """Dynamics, mount and lost readings of the gimbal on `link`, as settings of a SimulatedGimbal; none as default."""
    sections = [section for section in profile.sinks if isinstance(section, GimbalSection) and section.link == link]
    dynamics = [Dynamics()] * 3
    settings: dict[str, Any] = {}
    for section in sections:
        simulated = section.simulated
        for index, axis in enumerate(section.axes):
            if axis is not None:
                dynamics[index] = Dynamics(**simulated.of(axis.value))
        mount = half_turn(section.wiring.commanded_mount)
        settings["mount"] = mount if simulated.mount is None else simulated.mount
        settings["lost_readings"] = simulated.lost_readings
    usual = all(section.simulated == SimulatedSection() and not section.mount.yaw for section in sections)
    return {} if usual else {**settings, "dynamics": dynamics}


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
