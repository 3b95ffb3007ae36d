"""OSC: commands of buttons and faders, and feedback for them."""

from __future__ import annotations

import asyncio

from teleop.config.exchange.osc import OscSection
from teleop.exchange.served import Served


async def serve(section: OscSection, served: Served) -> None:  # noqa: ARG001
    """Serve until cancelled."""
    await asyncio.Event().wait()
