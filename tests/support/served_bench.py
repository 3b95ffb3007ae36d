"""A server of an exchange entry beside a rig whose virtual time passes as fast as it may, or as a clock says."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from remote_bench import RemoteBench, remote_bench

from teleop.exchange.served import Rig, Served
from teleop.gateway.door_client import DoorClient

Work = Callable[[RemoteBench, Served], Awaitable[Any]]
Server = Callable[[Served], Awaitable[None]]
PACE = 0.002  # s of the machine's time from one tick to the next at least: a server gets its turns
REAL = 0.01  # s: as fast as the machine's clock, for what compares the two


def beside_a_rig(folder: Path, server: Server, work: Work, pace: float = PACE) -> list[str]:
    """`work` while the server serves; the lines that it had for the operator."""
    lines: list[str] = []

    async def run() -> None:
        with remote_bench(folder) as bench:
            async with DoorClient(bench.hands.door.address) as door:
                limits = dict(bench.hands._limits)
                served = Served(door, Rig("Bench", limits, limits), None, lines.append)
                async with asyncio.timeout(30):
                    with turning(bench, pace), _task(server(served)):
                        await work(bench, served)

    asyncio.run(run())
    return lines


@contextmanager
def turning(bench: RemoteBench, pace: float) -> Iterator[None]:
    """Its time passes within."""

    async def turns() -> None:
        while True:
            bench.tick()
            await asyncio.sleep(pace)

    with _task(turns()):
        yield


@contextmanager
def _task(work: Awaitable[None]) -> Iterator[None]:
    task = asyncio.ensure_future(work)
    try:
        yield
        if task.done():
            task.result()
    finally:
        task.cancel()


async def until(condition: Callable[[], object], what: str = "") -> None:
    """Wait for it; the time-out of the bench ends what never comes."""
    while not condition():
        await asyncio.sleep(0.005)
    del what
