"""A client of a door in asyncio, against the control process's side, whose virtual time passes between its waits."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

from remote_bench import RemoteBench, remote_bench

from teleop.gateway.door_client import DoorClient

Work = Callable[[DoorClient, RemoteBench], Awaitable[None]]


def with_rig(folder: Path, work: Work) -> None:
    """`work` beside a rig whose time passes as fast as it may."""

    async def turning(bench: RemoteBench) -> None:
        while True:
            bench.loop.turn()
            await asyncio.sleep(0)

    async def run() -> None:
        with remote_bench(folder) as bench:
            async with DoorClient(bench.hands.door.address) as door:
                rig = asyncio.create_task(turning(bench))
                try:
                    await asyncio.wait_for(work(door, bench), 30)
                finally:
                    rig.cancel()

    asyncio.run(run())


async def settled(check: Callable[[], object]) -> None:
    """Wait until it is so."""
    while not check():
        await asyncio.sleep(0.001)
