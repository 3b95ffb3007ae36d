"""Whether a rig reaches what its entry connects to: Zenoh tries on and says nothing, so the operator would not know."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from teleop.config.exchange.zenoh import ZenohSection
from teleop.exchange.served import Served
from teleop.studio.credentials import Credentials
from teleop.studio.diagnosis import why_not

if TYPE_CHECKING:
    import zenoh

PATIENCE = 3.0  # s without a link before that is told
LOOK = 1.0  # s


async def tell_reached(
    section: ZenohSection, served: Served, session: zenoh.Session, credentials: Credentials | None
) -> None:
    """Until cancelled: a line when no endpoint of `connect` is reached, with the reason, and one when it is again."""
    silent, told = 0.0, False
    while section.connect:
        await asyncio.sleep(LOOK)
        if session.info.routers_zid() or session.info.peers_zid():
            if told:
                served.notify(f"zenoh: {', '.join(section.connect)}: reached")
            silent, told = 0.0, False
            continue
        silent += LOOK
        if silent >= PATIENCE and not told:
            told = True
            for each in section.connect:
                why = await asyncio.to_thread(why_not, each, credentials) or "it speaks no Zenoh"
                served.notify(f"zenoh: {each} is not reached: {why}; it is tried on")
