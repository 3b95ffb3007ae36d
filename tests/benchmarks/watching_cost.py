"""What those who only look cost: Foxglove with a client of every topic, and the announcement by mDNS.

`python tests/benchmarks/watching_cost.py [SECONDS]`: how old a tick is when Foxglove's client has it, processor time of
the gateway and of the control process without and with the client, in turns; how long until a rig is found by mDNS, and
what announcing takes from then on.
"""

from __future__ import annotations

import asyncio
import json
import socket
import statistics
import struct
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from processor_time import processor_time
from real_console import RealConsole
from real_exchange import free_port, real_exchange
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from teleop.gateway.discovery import Announcement, announced, browse

TURNS = 3


def watched(port: int, seconds: float) -> list[float]:
    """How old each message of `/motion` was when it came, in ms; every topic is asked for."""
    ages: list[float] = []
    with connect(f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol("foxglove.sdk.v1")], max_size=None) as client:
        motion, end = None, time.monotonic() + seconds
        while time.monotonic() < end:
            data = client.recv(timeout=10)
            if isinstance(data, str):
                channels = json.loads(data).get("channels", [])
                for each in channels:
                    motion = each["id"] if each["topic"] == "/motion" else motion
                asked = [{"id": each["id"], "channelId": each["id"]} for each in channels]
                client.send(json.dumps({"op": "subscribe", "subscriptions": asked}))
            elif data[0] == 1:
                number, moment = struct.unpack_from("<IQ", data, 1)
                if number == motion:
                    ages.append((time.time_ns() - moment) / 1e6)
    return ages


class Turn(NamedTuple):
    """Shares of a core, and what `watched` has."""

    control: float
    gateway: float
    ages: list[float]


def turn(console: RealConsole, port: int, seconds: float, watches: bool) -> Turn:
    """While pan moves."""
    control, gateway = console._process.pid, console.gateway
    console.request("api/command", {"do": "goto", "axes": {"pan": 90}, "seconds": seconds})
    before = processor_time(control), processor_time(gateway)
    ages = watched(port, seconds) if watches else []
    if not watches:
        time.sleep(seconds)
    spent = processor_time(control) - before[0], processor_time(gateway) - before[1]
    console.request("api/command", {"do": "goto", "axes": {"pan": 0}, "seconds": 2, "wait": True})
    return Turn(spent[0] / seconds, spent[1] / seconds, ages)


def foxglove(seconds: float) -> None:
    port = free_port()
    with (
        tempfile.TemporaryDirectory() as folder,
        real_exchange(Path(folder), f"{{type: foxglove, listen: '127.0.0.1:{port}'}}") as console,
    ):
        turns = [(turn(console, port, seconds, False), turn(console, port, seconds, True)) for _ in range(TURNS)]
    ages = sorted(age for _, watching in turns for age in watching.ages)
    middle, late = ages[len(ages) // 2], ages[int(0.99 * len(ages))]
    alone, watching = ([pair[which] for pair in turns] for which in range(2))
    gateway, gateway_with = (statistics.mean(each.gateway for each in found) for found in (alone, watching))
    control, control_with = (statistics.mean(each.control for each in found) for found in (alone, watching))
    print(f"Foxglove: a tick is {middle:.1f} ms old at the client, p99 {late:.1f} ms")
    print(f"  gateway: {gateway:.1%} of a core without a client, {gateway_with:.1%} with one")
    print(f"  control process: {control:.1%} without, {control_with:.1%} with: ratio {control_with / control:.2f}")


async def mdns(seconds: float) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        with suppress(OSError):
            probe.connect(("224.0.0.251", 5353))
        host = probe.getsockname()[0]
    begun = time.monotonic()
    async with announced(Announcement("Bench", host, 8470)) as name:
        registered = time.monotonic() - begun
        found = [each.name for each in await browse(1.5, [host])]
        before = time.process_time()
        await asyncio.sleep(seconds)
        spent = (time.process_time() - before) / seconds
    print(f"mDNS: announced after {registered:.1f} s, then found: {name in found}; {spent:.2%} of a core from then on")


if __name__ == "__main__":
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    foxglove(seconds)
    asyncio.run(mdns(seconds))
