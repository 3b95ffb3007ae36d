"""All entries of an exchange, served side by side: one that fails is served again, and disturbs no other."""

from __future__ import annotations

import asyncio
import importlib
import os
import socket
import sys
from collections.abc import Mapping
from typing import Any

from teleop.config.exchange import ENTRIES, ExchangeSection, tracks
from teleop.core.axes import Axis, Limits
from teleop.core.errors import TeleopError
from teleop.exchange import SERVERS
from teleop.exchange.served import Rig, Served
from teleop.gateway.door_client import DoorClient

AGAIN, LONGEST = 1.0, 30.0  # s until an entry that failed is served again: doubled each time, up to the longest
LOOK = 0.02  # s between two looks for the first state
WORKED = 60.0  # s of serving after which a failure is a new one: said, and tried again soon


def load(settings: Mapping[str, Any]) -> None:
    """Import what serves the entries: what takes time is done before any of them is served."""
    for entry in settings["entries"]:
        importlib.import_module(SERVERS[entry["type"]])


async def serve(settings: Mapping[str, Any], door: DoorClient) -> None:
    """Serve what `opening` put into the settings of the gateway, until cancelled; from the rig's first state on."""
    limits = {Axis(name): Limits(*values) for name, values in settings["rig"]["limits"].items()}
    while not (state := door.newest()):
        await asyncio.sleep(LOOK)
    moved = {axis: of for axis, of in limits.items() if axis.value in state["axes"]}
    rig = Rig(settings["rig"]["name"], limits, moved)
    entries = ENTRIES.validate_python(settings["entries"])
    tracker = 0
    async with asyncio.TaskGroup() as tasks:
        for entry, number in zip(entries, settings["listeners"], strict=True):
            tracker += tracks(entry)
            tasks.create_task(_kept(entry, Served(door, rig, _listener(number), _notify, tracker)))


def _listener(number: int | None) -> socket.socket | None:
    """A copy of the inherited descriptor; closing it leaves the control process's own open."""
    if number is None:
        return None
    listener = socket.socket(fileno=os.dup(number))
    listener.setblocking(False)
    return listener


async def _kept(entry: ExchangeSection, served: Served) -> None:
    """Serve an entry, again and again where it fails."""
    server = importlib.import_module(SERVERS[entry.type])
    wait, before = AGAIN, ""
    clock = asyncio.get_running_loop().time
    while True:
        began = clock()
        try:
            await server.serve(entry, served)
            return
        except (TeleopError, OSError) as error:
            why = str(error)
        if clock() - began >= WORKED:
            wait, before = AGAIN, ""
        if why != before:
            served.notify(f"exchange {entry.type}: {why}: tried again until it works")
            before = why
        await asyncio.sleep(wait)
        wait = min(LONGEST, 2 * wait)


def _notify(line: str) -> None:
    """To the control process, which shows it to the operator."""
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()
