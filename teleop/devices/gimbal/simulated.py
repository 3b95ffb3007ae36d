"""The simulated gimbal at the end of a `sim:` link, and the cable to it, as the profile has them."""

from __future__ import annotations

from collections.abc import Callable

from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.devices.gimbal.profile_firmware import profile_firmware
from teleop.devices.gimbal.profile_simulation import sections_on, simulated_settings
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.link import FaultyWire


def simulated_gimbal(
    profile: Profile, link: str, make: Callable[..., SimulatedGimbal] = SimulatedGimbal
) -> SimulatedGimbal:
    """As the `simulated` keys of the gimbal on `link` have it."""
    continuous = Axis.PAN in profile.limits and profile.limits[Axis.PAN].continuous
    settings, firmware = simulated_settings(profile, link), profile_firmware(profile, link)
    return make(continuous=continuous, firmware=firmware, **settings)


def simulated_wire(
    profile: Profile, link: str, gimbal: SimulatedGimbal, now: Callable[[], float], *, first: bool = True
) -> FaultyWire:
    """The cable with the faults of the profile; an adapter resets only after it was opened `first`."""
    wires = [section.simulated for section in sections_on(profile, link)]
    if not wires:
        return FaultyWire(gimbal, now)
    of = wires[0]
    return FaultyWire(gimbal, now, of.bus_errors, of.adapter_reset if first else 0.0, of.foreign_traffic)
