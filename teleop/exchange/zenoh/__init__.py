"""A rig among several, by Zenoh: its state is pushed, commands are answered, sticks have the dead man of the door."""

from __future__ import annotations

import asyncio

from teleop.config.exchange.zenoh import ZenohSection
from teleop.core.errors import UsageError
from teleop.exchange.served import Served
from teleop.exchange.zenoh.bridge import Bridge
from teleop.exchange.zenoh.reaching import tell_reached
from teleop.studio.credentials import Credentials, load
from teleop.studio.transport import opened


async def serve(section: ZenohSection, served: Served) -> None:
    """Serve until cancelled. Raises TeleopError for credentials that cannot be used and a taken port."""
    credentials = None if section.credentials is None else load(section.credentials)
    if credentials is not None and (wrong := unfit(section.name, credentials)):
        raise UsageError(f"{section.credentials}: {wrong}")
    access = None if credentials is None else credentials.access()
    listen = [section.listen] if section.listen else []
    session = await asyncio.to_thread(opened, "peer", listen, section.connect, credentials, access)
    reaching = asyncio.create_task(tell_reached(section, served, session, credentials))
    try:
        await Bridge(section, served, session, asyncio.get_running_loop()).run()
    finally:
        reaching.cancel()
        session.close()  # else its threads keep the process


def unfit(name: str, credentials: Credentials) -> str:
    """Why a rig of this name would reach no one with these credentials, "" for those that fit."""
    if credentials.name != name:
        return f"is of {credentials.name}, and the entry is called {name}: both must have one name"
    if (role := credentials.members.get(name)) != "rig":
        known = f"has {name} as `{role}`" if role else f"does not have {name}"
        return (
            f"its access list {known}: make it with `teleop fleet keys FOLDER --rig {name}`, or copy access.yaml anew"
        )
    return ""
