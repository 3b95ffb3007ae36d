"""The gimbal's link alone, opened, and opened again after it was lost: to a real adapter, or a simulated gimbal."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.errors import LinkError, UsageError
from teleop.core.interfaces import Clock, Link
from teleop.devices.connection import Connection
from teleop.devices.gimbal.simulated import simulated_gimbal, simulated_wire
from teleop.links import ClosableLink, open_link
from teleop.links.url import LinkAddress, parse
from teleop.sim.gimbal.device import SimulatedGimbal


class GimbalLink:
    """Of the first gimbal of the profile. Raises UsageError where it has none.

    `simulated` is the gimbal of a `sim:` link, the same one however often the link is opened. `tap` is called with each
    link that is opened, and gives the one to use.
    """

    def __init__(self, profile: Profile, clock: Clock, simulated: SimulatedGimbal | None = None) -> None:
        sections = [section for section in profile.sinks if isinstance(section, GimbalSection)]
        if not sections:
            raise UsageError(f"{profile.name} has no gimbal: teleop commission measures one")
        self.section = sections[0]
        self.url = profile.links[self.section.link]
        self._profile, self._clock = profile, clock
        self.tap: Callable[[Link], Link] = lambda link: link
        self.simulated = simulated
        if simulated is None and self.address.kind == "sim":
            self.simulated = simulated_gimbal(profile, self.section.link)
        self._link: ClosableLink | None = None
        self._opened = 0

    @property
    def address(self) -> LinkAddress:
        return parse(self.url)

    def open(self) -> Connection:
        """Raises LinkError."""
        self.close()
        name, now = self.section.link, self._clock.now
        if self.simulated is not None:
            wire = simulated_wire(self._profile, name, self.simulated, now, first=not self._opened)
            self._opened += 1
            return Connection(name, self.url, self.tap(wire), now(), wire.counts)
        self._link = link = open_link(self.address, now=now)
        return Connection(name, self.url, self.tap(link), now(), link.counts)

    def close(self) -> None:
        if self._link is not None:
            with contextlib.suppress(LinkError):
                self._link.close()
            self._link = None
