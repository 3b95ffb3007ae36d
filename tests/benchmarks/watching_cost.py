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


def shares(console: RealConsole, port: int, seconds: float, watches: bool) -> tuple[float, float, list[float]]:
    """Of a core, for the control process and its gateway, while pan moves; and what `watched` has."""
    control, gateway = console._process.pid, console.gateway
    console.request("api/command", {"do": "goto", "axes": {"pan": 90}, "seconds": seconds})
    before = processor_time(control), processor_time(gateway)
    ages = watched(port, seconds) if watches else []
    if not watches:
        time.sleep(seconds)
    found = (processor_time(control) - before[0]) / seconds, (processor_time(gateway) - before[1]) / seconds, ages
    console.request("api/command", {"do": "goto", "axes": {"pan": 0}, "seconds": 2, "wait": True})
    return found


def foxglove(seconds: float) -> None:
    port = free_port()
    with (
        tempfile.TemporaryDirectory() as folder,
        real_exchange(Path(folder), f"{{type: foxglove, listen: '127.0.0.1:{port}'}}") as console,
    ):
        turns = [(shares(console, port, seconds, False), shares(console, port, seconds, True)) for _ in range(TURNS)]
    ages = sorted(age for _, with_client in turns for age in with_client[2])
    (control, gateway), (control_with, gateway_with) = (
        tuple(statistics.mean(turn[which][process] for turn in turns) for process in range(2)) for which in range(2)
    )
    print(
        f"Foxglove: a tick is {ages[len(ages) // 2]:.1f} ms old at the client, p99 {ages[int(0.99 * len(ages))]:.1f} ms"
    )
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
