"""What the `simulated` keys of a profile make of the gimbal that a `sim:` link or `teleop sim` simulates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from teleop.config.profile import Profile
from teleop.config.simulated_firmware import SimulatedFirmwareSection
from teleop.config.simulated_section import SimulatedSection
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import half_turn
from teleop.core.axes import Axis
from teleop.sim.gimbal.device import JOYSTICK_SPEED
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware

_SETTINGS = "push_rate", "reaction"  # of the gimbal, not of its firmware; so are its signs
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
        if simulated.signs:
            settings["signs"] = position_signs(section)
    return settings


def simulated_firmware(profile: Profile, link: str) -> Firmware:
    """The firmware that the `simulated` keys of the gimbal on `link` make."""
    for section in sections_on(profile, link):
        if section.simulated != SimulatedSection():
            return Firmware(**_firmware(section))
    return DOCUMENTED


def _firmware(section: GimbalSection) -> dict[str, Any]:
    simulated, fields, signs = section.simulated, dict[str, Any](), position_signs(section)
    for key in SimulatedFirmwareSection.model_fields:
        value = getattr(simulated, key)
        if key in _BY_AXIS and value:
            pairs = zip(section.axes, _BY_AXIS[key], strict=True)
            values = [usual if axis is None else value.get(axis.value, usual) for axis, usual in pairs]
            counted = zip(values, signs, strict=True)  # the other way than positions
            fields[key] = tuple(values) if key == "stick_speed" else tuple(value * sign for value, sign in counted)
        elif key not in _BY_AXIS and key not in (*_SETTINGS, "signs"):
            fields[_RENAMED.get(key, key)] = tuple(value) if isinstance(value, list) else value
    return fields


def position_signs(section: GimbalSection) -> tuple[int, int, int]:
    """Which way the simulated gimbal counts positions of yaw, roll and pitch."""
    signs = {Axis(name): sign for name, sign in section.simulated.signs.items()}
    yaw, roll, pitch = (1 if axis is None else signs.get(axis, 1) for axis in section.axes)
    return yaw, roll, pitch
