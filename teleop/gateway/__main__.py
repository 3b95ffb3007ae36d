"""The gateway process: `python -m teleop.gateway`, started by the control process and by nobody else.

Its input has one line of settings, and ends when the control process does; then it ends too, at once, so that nothing
on the network believes in a rig that is gone.
"""

from __future__ import annotations

import asyncio
import ctypes
import importlib
import importlib.util
import json
import os
import signal
import socket
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from teleop.core.errors import TeleopError
from teleop.door.address import DoorAddress
from teleop.gateway.door_client import DoorClient

PR_SET_PDEATHSIG = 1
LEAVING = 0.3  # s for answers under way, once the control process has ended


def main() -> int:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _die_with_parent()
    line = sys.stdin.buffer.readline()
    if not line:
        return 0
    settings = json.loads(line)
    _load(settings)
    try:
        asyncio.run(_serve(settings))
    except TeleopError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


def _load(settings: dict[str, Any]) -> None:
    """Import what will be served before the first word: on a busy computer it takes seconds, which would be a hang."""
    if "console" in settings:
        importlib.import_module("teleop.console.server")
    if "exchange" in settings:
        importlib.import_module("teleop.exchange.serving").load(settings["exchange"])


async def _serve(settings: dict[str, Any]) -> None:
    ended = asyncio.Event()
    loop = asyncio.get_running_loop()
    threading.Thread(target=_watch_parent, args=(loop, ended), name="parent", daemon=True).start()
    async with DoorClient(DoorAddress(Path(settings["door"]))) as door:
        waiting: asyncio.Task[Any] = loop.create_task(ended.wait())
        served: list[asyncio.Task[Any]] = [
            loop.create_task(serve(settings[part], door)) for part, serve in PARTS.items() if part in settings
        ]
        done, _ = await asyncio.wait([*served, waiting], return_when=asyncio.FIRST_COMPLETED)
        for task in (*served, waiting):
            task.cancel()
        await asyncio.gather(*served, waiting, return_exceptions=True)
        for task in done - {waiting}:
            task.result()


async def _console(settings: dict[str, Any], door: DoorClient) -> None:
    """The web console, which this module does not know before it is asked for: it is the layer above."""
    server = importlib.import_module("teleop.console.server")
    kept = importlib.import_module("teleop.console.settings").ConsoleSettings.from_json(settings["settings"])
    listener = socket.socket(fileno=os.dup(settings["listener"]))
    listener.setblocking(False)
    await server.serve(kept, door, listener)


async def _exchange(settings: dict[str, Any], door: DoorClient) -> None:
    """What a studio's other programs speak; a layer above as well."""
    await importlib.import_module("teleop.exchange.serving").serve(settings, door)


async def _announcement(settings: dict[str, Any], door: DoorClient) -> None:  # noqa: ARG001 - as the other parts
    """The run on mDNS, by a child that says goodbye when this process has ended, whatever ended it."""
    if importlib.util.find_spec("zeroconf") is None:
        sys.stderr.write("mDNS: the rig is not announced: pip install 'rs-teleop[console]'\n")
        await asyncio.Event().wait()
    command = [sys.executable, "-m", "teleop.gateway.announcer"]
    child = await asyncio.create_subprocess_exec(*command, stdin=asyncio.subprocess.PIPE, start_new_session=True)
    assert child.stdin is not None
    try:
        child.stdin.write(json.dumps(settings).encode() + b"\n")
        if code := await child.wait():
            sys.stderr.write(f"mDNS: the rig is no longer announced: code {code}\n")
        await asyncio.Event().wait()
    finally:
        child.stdin.close()


PARTS = {"console": _console, "exchange": _exchange, "announcement": _announcement}
"""What the gateway may be told to serve."""


def _watch_parent(loop: asyncio.AbstractEventLoop, ended: asyncio.Event) -> None:
    """In a thread: an event loop that hangs does not keep the process."""
    while os.read(sys.stdin.fileno(), 4096):
        pass
    with suppress(RuntimeError):  # the loop is closed already
        loop.call_soon_threadsafe(ended.set)
    time.sleep(LEAVING)
    os._exit(0)


def _die_with_parent() -> None:
    """Linux ends this process with its parent even while it is stopped; elsewhere its closed input does."""
    parent = os.getppid()
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
