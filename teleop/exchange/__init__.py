"""What the gateway speaks beside the console: each type of a profile's `exchange` is a module, served in one process.

A module has `async def serve(section, served)`, which runs until it is cancelled; `SERVERS` names it.
"""

from __future__ import annotations

from collections.abc import Mapping

SERVERS: Mapping[str, str] = {
    "dfmoco": "teleop.exchange.dfmoco",
    "foxglove": "teleop.exchange.foxglove",
    "freed": "teleop.exchange.freed",
    "midi": "teleop.exchange.midi",
    "opentrackio": "teleop.exchange.opentrackio",
    "osc": "teleop.exchange.osc",
    "timecode": "teleop.exchange.timecode",
    "zenoh": "teleop.exchange.zenoh",
}
"""The module that serves each type."""
