"""A device's link alone, opened, and opened again after it was lost."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from teleop.core.errors import LinkError
from teleop.core.interfaces import Clock, Link
from teleop.links import OpenLink, open_link
from teleop.links.url import LinkAddress, parse


class DeviceLink:
    """`tap` is called with each link that is opened, and gives the one to use."""

    def __init__(self, url: str, clock: Clock) -> None:
        self.url = url
        self.tap: Callable[[Link], Link] = lambda link: link
        self._clock = clock
        self._link: OpenLink | None = None

    @property
    def address(self) -> LinkAddress:
        return parse(self.url)

    def close(self) -> None:
        if self._link is not None:
            with contextlib.suppress(LinkError):
                self._link.close()
            self._link = None

    def _open_real(self) -> OpenLink:
        """The real link, open until `close`. Raises LinkError."""
        self._link = link = open_link(self.address, now=self._clock.now)
        return link
