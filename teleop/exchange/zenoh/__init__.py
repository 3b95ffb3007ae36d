"""A rig among several, by Zenoh: its state is pushed, commands are answered, sticks have the dead man of the door."""

from __future__ import annotations

import asyncio

from teleop.config.exchange.zenoh import ZenohSection
from teleop.exchange.served import Served
from teleop.exchange.zenoh.bridge import Bridge
from teleop.exchange.zenoh.reaching import tell_reached
from teleop.studio.credentials import load
from teleop.studio.transport import opened


async def serve(section: ZenohSection, served: Served) -> None:
    """Serve until cancelled. Raises TeleopError for credentials that cannot be used and a taken port."""
    credentials = None if section.credentials is None else load(section.credentials)
    access = None if credentials is None else credentials.access()
    listen = [section.listen] if section.listen else []
    session = await asyncio.to_thread(opened, "peer", listen, section.connect, credentials, access)
    reaching = asyncio.create_task(tell_reached(section, served, session, credentials))
    try:
        await Bridge(section, served, session, asyncio.get_running_loop()).run()
    finally:
        reaching.cancel()
        session.close()  # else its threads keep the process
