"""STOP for everybody: it needs no control, and is sent until the rig confirms it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any

from teleop.console.door import Door

LONGEST = 10.0  # s of sending; a control process that does not answer for so long is gone
LOOK, LOOKS = 0.01, 20  # s from one look at the state to the next, and how many
LOST = "STOP was sent, but the rig does not confirm it: switch the gimbal off"


async def stop(door: Door, session: str, name: str) -> Mapping[str, Any]:
    """The answer once the state shows the STOP; the door sends it again until then.

    A control process that has answered has obeyed: where the state does not show it, someone else has cleared it since.
    """
    loop = asyncio.get_running_loop()
    end = loop.time() + LONGEST
    while loop.time() < end:
        found = await door.command({"do": "stop"}, session, name)
        if found.get("ok"):
            for _ in range(LOOKS):
                if door.state().get("stopped"):
                    break
                await asyncio.sleep(LOOK)
            return {"ok": True, "stopped": bool(door.state().get("stopped"))}
        await asyncio.sleep(LOOK)
    return {"error": LOST, "kind": "lost"}
