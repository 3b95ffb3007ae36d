"""The drone's link alone, opened, and opened again after it was lost: a real serial line, or a simulated drone."""

from __future__ import annotations

import contextlib
import secrets
from collections.abc import Callable

from teleop.config.credentials import app_cipher
from teleop.config.profile import Profile
from teleop.config.sinks_section import FlightSection, VirtualRcSection
from teleop.core.errors import LinkError, UsageError
from teleop.core.interfaces import Clock, Link
from teleop.devices.connection import Connection
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.drone.session import OnboardSession
from teleop.links import ClosableLink, open_link
from teleop.links.url import LinkAddress, parse
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.link import SimLink


class DroneLink:
    """Of the first drone of the profile. Raises UsageError where it has none.

    `simulated` is the drone of a `sim:` link, the same one however often the link is opened. `tap` is called with each
    link that is opened, and gives the one to use.
    """

    def __init__(self, profile: Profile, clock: Clock, simulated: SimulatedDrone | None = None) -> None:
        sections = [each for each in profile.sinks if isinstance(each, VirtualRcSection | FlightSection)]
        if not sections:
            raise UsageError(f"{profile.name} has no drone")
        self.section = sections[0]
        self.url = profile.links[self.section.link]
        self.cipher = app_cipher(self.section.encrypted)
        self.tap: Callable[[Link], Link] = lambda link: link
        self.simulated = simulated
        if simulated is None and self.address.kind == "sim":
            self.simulated = SimulatedDrone(now=clock.now(), cipher=app_cipher(self.section.encrypted))
        self._clock = clock
        self._link: ClosableLink | None = None

    @property
    def address(self) -> LinkAddress:
        return parse(self.url)

    def open(self) -> Connection:
        """Raises LinkError."""
        self.close()
        name, now = self.section.link, self._clock.now
        session = OnboardSession(M100, secrets.randbelow(0x10000))  # unlike that of an earlier run
        if self.simulated is not None:
            return Connection(name, self.url, self.tap(SimLink(self.simulated, now)), now(), None, session)
        self._link = link = open_link(self.address, now=now)
        return Connection(name, self.url, self.tap(link), now(), link.counts, session)

    def close(self) -> None:
        if self._link is not None:
            with contextlib.suppress(LinkError):
                self._link.close()
            self._link = None
