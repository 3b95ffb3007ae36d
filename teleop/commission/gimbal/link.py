"""The gimbal's link alone: to a real adapter, or a simulated gimbal."""

from __future__ import annotations

from teleop.commission.device_link import DeviceLink
from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.errors import UsageError
from teleop.core.interfaces import Clock
from teleop.devices.connection import Connection
from teleop.devices.gimbal.simulated import simulated_gimbal, simulated_wire
from teleop.sim.gimbal.device import SimulatedGimbal


class GimbalLink(DeviceLink):
    """Of the first gimbal of the profile. Raises UsageError where it has none.

    `simulated` is the gimbal of a `sim:` link, the same one however often the link is opened.
    """

    def __init__(self, profile: Profile, clock: Clock, simulated: SimulatedGimbal | None = None) -> None:
        sections = [section for section in profile.sinks if isinstance(section, GimbalSection)]
        if not sections:
            raise UsageError(f"{profile.name} has no gimbal: teleop commission measures one")
        self.section = sections[0]
        super().__init__(profile.links[self.section.link], clock)
        self._profile = profile
        self.simulated = simulated
        if simulated is None and self.address.kind == "sim":
            self.simulated = simulated_gimbal(profile, self.section.link)
        self._opened = 0

    def open(self) -> Connection:
        """Raises LinkError."""
        self.close()
        name, now = self.section.link, self._clock.now
        if self.simulated is not None:
            wire = simulated_wire(self._profile, name, self.simulated, now, first=not self._opened)
            self._opened += 1
            return Connection(name, self.url, self.tap(wire), now(), wire.counts)
        link = self._open_real()
        return Connection(name, self.url, self.tap(link), now(), link.counts)
