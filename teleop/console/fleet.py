"""The other rigs of a fleet on the page: what each does, and STOP for all, by everybody who is logged in.

The rig's own entry in the exchange says who else there is: those at its `connect`, and those that are linked to its
`listen`. Threads of the fleet do the work; here they are only asked. Nothing is opened before a page asks.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from starlette.requests import Request
from starlette.responses import Response

from teleop.config.exchange.endpoint import endpoint
from teleop.config.exchange.zenoh import ZenohSection
from teleop.console.answers import answer
from teleop.console.json_body import Refusal
from teleop.core.errors import TeleopError

if TYPE_CHECKING:
    from teleop.studio.fleet import Fleet

NO_FLEET = "this rig has no zenoh entry in its exchange"


class FleetRoutes:
    """Handlers of `/api/fleet` and `/api/fleet/stop`; `section` is the rig's entry, None for a rig that is alone."""

    def __init__(self, section: ZenohSection | None) -> None:
        self._section = section
        self._fleet: Fleet | None = None
        self._opening = asyncio.Lock()

    async def rigs(self, _: Request) -> Response:
        """Every rig of the fleet that was seen, this one included; none where it has no fleet."""
        if self._section is None:
            return answer({"rigs": []})
        fleet = await self._opened()
        return answer({"name": self._section.name, "rigs": [rig.as_json() for rig in fleet.rigs]})

    async def stop(self, _: Request) -> Response:
        """STOP for all rigs, until the state of each shows it; the names of those that do not show it."""
        from teleop.studio.stopping import stop

        if self._section is None:
            raise Refusal(404, NO_FLEET)
        fleet = await self._opened()
        missed = await asyncio.to_thread(stop, fleet)
        return answer({"ok": not missed, "not_reached": missed})

    async def close(self) -> None:
        """Leave the fleet."""
        if self._fleet is not None:
            await asyncio.to_thread(self._fleet.close)

    async def _opened(self) -> Fleet:
        from teleop.studio.credentials import load
        from teleop.studio.fleet import Fleet

        assert self._section is not None
        async with self._opening:
            if self._fleet is None:
                try:
                    known = None if self._section.credentials is None else load(self._section.credentials)
                    fleet = Fleet(endpoints(self._section), known, f"{self._section.name} console"[:40], memory=False)
                except TeleopError as error:
                    raise Refusal(503, str(error)) from None
                self._fleet = fleet.__enter__()
        return self._fleet


def endpoints(section: ZenohSection) -> list[str]:
    """Where the fleet of a rig is reached from its own machine: what it connects to, and its own listener."""
    found = list(section.connect)
    if section.listen and (own := endpoint(section.listen)).address.port:
        host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(own.address.host, own.address.host)
        found.append(f"{own.protocol}/{own.address._replace(host=host)}")
    return found
