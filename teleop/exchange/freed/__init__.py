"""FreeD D1: the camera's attitude, as often as the receiver needs it, or a tracker's for the rig to follow."""

from __future__ import annotations

from teleop.config.exchange.freed import FreeDSection
from teleop.exchange.freed.following import receive
from teleop.exchange.freed.sending import send
from teleop.exchange.served import Served


async def serve(section: FreeDSection, served: Served) -> None:
    """Send or follow until cancelled. Raises TeleopError where the receiver's host is unknown."""
    if section.to is not None:
        await send(section, section.to, served)
    elif section.listen is not None:
        await receive(section, section.listen, served)
