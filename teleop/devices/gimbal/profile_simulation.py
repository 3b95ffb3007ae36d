"""What the `simulated` keys of a profile make of the gimbal that a `sim:` link or `teleop sim` simulates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from teleop.config.profile import Profile
from teleop.config.simulated_firmware import SimulatedFirmwareSection
from teleop.config.simulated_section import SimulatedSection
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import half_turn
from teleop.sim.gimbal.device import JOYSTICK_SPEED
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware

_SETTINGS = "push_rate", "reaction"  # of the gimbal, not of its firmware
_BY_AXIS: Mapping[str, tuple[float, float, float]] = {
    "speed_signs": (1, 1, 1),
    "report_signs": (1, 1, 1),
    "stick_speed": JOYSTICK_SPEED,
}
"""Keys with a value for each axis, and what yaw, roll and pitch have otherwise."""
_RENAMED: Mapping[str, str] = {"ignore_speed": "ignores_speed", "ignore_zero_focus": "ignores_zero_focus"}


def sections_on(profile: Profile, link: str) -> list[GimbalSection]:
    """The gimbal sections of the profile on `link`."""
    return [section for section in profile.sinks if isinstance(section, GimbalSection) and section.link == link]


def simulated_settings(profile: Profile, link: str) -> dict[str, Any]:
    """Dynamics, mount and rates of the gimbal on `link`, as settings of a SimulatedGimbal; none as default."""
    sections = sections_on(profile, link)
    if all(section.simulated == SimulatedSection() and not section.mount.yaw for section in sections):
        return {}
    dynamics = [Dynamics()] * 3
    settings: dict[str, Any] = {"dynamics": dynamics}
    for section in sections:
        simulated = section.simulated
        for index, axis in enumerate(section.axes):
            if axis is not None:
                dynamics[index] = Dynamics(**simulated.of(axis.value))
        mount = half_turn(section.wiring.commanded_mount)
        settings["mount"] = mount if simulated.mount is None else simulated.mount
        settings |= {key: getattr(simulated, key) for key in ("lost_readings", *_SETTINGS)}
    return settings


def simulated_firmware(profile: Profile, link: str) -> Firmware:
    """The firmware that the `simulated` keys of the gimbal on `link` make."""
    for section in sections_on(profile, link):
        if section.simulated != SimulatedSection():
            return Firmware(**_firmware(section))
    return DOCUMENTED


def _firmware(section: GimbalSection) -> dict[str, Any]:
    simulated, fields = section.simulated, dict[str, Any]()
    for key in SimulatedFirmwareSection.model_fields:
        value = getattr(simulated, key)
        if key in _BY_AXIS and value:
            pairs = zip(section.axes, _BY_AXIS[key], strict=True)
            fields[key] = tuple(usual if axis is None else value.get(axis.value, usual) for axis, usual in pairs)
        elif key not in _BY_AXIS and key not in _SETTINGS:
            fields[_RENAMED.get(key, key)] = value
    return fields
