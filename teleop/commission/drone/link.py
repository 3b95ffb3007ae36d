"""The drone's link alone: a real serial line, or a simulated drone."""

from __future__ import annotations

import secrets

from teleop.commission.device_link import DeviceLink
from teleop.config.credentials import app_cipher
from teleop.config.profile import Profile
from teleop.config.sinks_section import FlightSection, VirtualRcSection
from teleop.core.errors import UsageError
from teleop.core.interfaces import Clock
from teleop.devices.connection import Connection
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.drone.session import OnboardSession
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.link import SimLink


class DroneLink(DeviceLink):
    """Of the first drone of the profile. Raises UsageError where it has none.

    `simulated` is the drone of a `sim:` link, the same one however often the link is opened.
    """

    def __init__(self, profile: Profile, clock: Clock, simulated: SimulatedDrone | None = None) -> None:
        sections = [each for each in profile.sinks if isinstance(each, VirtualRcSection | FlightSection)]
        if not sections:
            raise UsageError(f"{profile.name} has no drone")
        self.section = sections[0]
        super().__init__(profile.links[self.section.link], clock)
        self.cipher = app_cipher(self.section.encrypted)
        self.simulated = simulated
        if simulated is None and self.address.kind == "sim":
            self.simulated = SimulatedDrone(now=clock.now(), cipher=self.cipher)

    def open(self) -> Connection:
        """Raises LinkError."""
        self.close()
        name, now = self.section.link, self._clock.now
        session = OnboardSession(M100, secrets.randbelow(0x10000))  # unlike that of an earlier run
        if self.simulated is not None:
            return Connection(name, self.url, self.tap(SimLink(self.simulated, now)), now(), None, session)
        link = self._open_real()
        return Connection(name, self.url, self.tap(link), now(), link.counts, session)
