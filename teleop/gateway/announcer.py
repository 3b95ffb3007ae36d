"""The process that announces a run by mDNS: `python -m teleop.gateway.announcer`, a child of the gateway.

It is a process of its own so that the rig is taken back, by mDNS's goodbye, however the gateway or the control process
ended: its input ends then. Its first line has what to announce.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
import threading
from contextlib import suppress

from teleop.core.errors import TeleopError
from teleop.gateway.discovery import Announcement, announced
from teleop.gateway.own_addresses import addresses_of

LOOK = 5.0  # s between two looks at the addresses of this computer
LEAVING = 0.45  # s for the goodbye; all three of its messages take 0.25 s


def main() -> int:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    line = sys.stdin.buffer.readline()
    if line:
        asyncio.run(_announce(Announcement.from_settings(json.loads(line))))
    return 0


async def _announce(what: Announcement) -> None:
    """Until the input ends."""
    work = asyncio.create_task(_kept(what))
    threading.Thread(target=_watch_parent, args=(asyncio.get_running_loop(), work), daemon=True).start()
    with suppress(asyncio.CancelledError):
        await work


async def _kept(what: Announcement) -> None:
    """Announced, and anew where this computer's addresses change; until cancelled."""
    said = ""
    while True:
        addresses = addresses_of(what.host)
        try:
            async with announced(what) as name:
                if name != what.rig and name != said:
                    _say(f"this rig is {name} on the network: another one has its name, or a label cannot have it")
                said = name
                while addresses_of(what.host) == addresses:
                    await asyncio.sleep(LOOK)
        except (TeleopError, OSError) as error:
            if str(error) != said:
                said = str(error)
                _say(said)
            await asyncio.sleep(LOOK)


def _say(line: str) -> None:
    with suppress(OSError):  # the gateway is gone, and so is who would hear it
        sys.stderr.write(f"mDNS: {line}\n")
        sys.stderr.flush()


def _watch_parent(loop: asyncio.AbstractEventLoop, work: asyncio.Task[None]) -> None:
    while os.read(sys.stdin.fileno(), 4096):
        pass
    threading.Timer(LEAVING, os._exit, (0,)).start()
    with suppress(RuntimeError):  # the loop is closed already
        loop.call_soon_threadsafe(work.cancel)


if __name__ == "__main__":
    sys.exit(main())
