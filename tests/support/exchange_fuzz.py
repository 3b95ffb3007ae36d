"""Hostile OSC packets and DFMoco lines: noise, and known ones with some of it wrong.

The judges are independent of what is judged: python-osc for packets, and a pattern for lines. Where neither
sees a command, nothing is asked of the rig.
"""

from __future__ import annotations

import asyncio
import logging
import re
import struct
from contextlib import suppress
from random import Random

from fake_door import FakeDoor
from pythonosc.osc_packet import OscPacket

from teleop.config.exchange.dfmoco import DfmocoSection
from teleop.core.axes import Axis, Limits
from teleop.exchange.client import Client, Peers
from teleop.exchange.dfmoco.controller import Controller
from teleop.exchange.dfmoco.lines import LineReader
from teleop.exchange.dfmoco.motors import motors_of
from teleop.exchange.osc.server import Inlet, Outlet
from teleop.exchange.served import Rig, Served
from teleop.links.osc_packets import BUNDLE, packet

LIMITS = {axis: Limits(-180.0, 180.0, 60.0, 240.0, 2400.0) for axis in (Axis.PAN, Axis.TILT, Axis.ROLL)}
ADDRESSES = ["/teleop/goto", "/teleop/jog/pan", "/teleop/preset/1", "/teleop/play", "/teleop/speed", "/teleop/record"]
ADDRESSES += [
    "/teleop/clear",
    "/teleop/fly",
    "/teleop/*",
    "/other",
    "/teleop/goto/pan",
    "/teleop//",
    "/",
    "/teleop/stop/x",
]
VALUES = [0, 1, -1, 2**31 - 1, 0.5, -90.0, 1e38, float("nan"), float("inf"), "reveal", "", "x" * 300, True, False]
NAMES = ["hi", "ms", "mm", "mp", "sm", "sa", "jm", "im", "pr", "zm", "np", "bf", "go", "xx", "", "MM", "m"]
NUMBERS = [
    "1",
    "2",
    "4",
    "9",
    "0",
    "-1",
    "600",
    "1e3",
    "0x10",
    "99999999999",
    "-2147483648",
    "1000",
    "500",
    "",
    "\x00",
    "\xff",
]
LINES = [b"mm 1 600", b"mm 2 -5", b"jm 3 3000 5000", b"im 1 10", b"bf 1000 500 1 0 100 200", b"go", b"sa", b"np 1 7"]
MOVING = re.compile(rb"(?:^|[\r\n])[ \t]*(?:(?:mm|jm|im|bf) +[-+0-9 \t]+|go[^\r\n]*)(?=[\r\n])", re.DOTALL)
MOVES = ("goto", "go_motion", "jog", "play", "preset_recall")


def osc_packet(chance: Random) -> bytes:
    """Most are no packet, or none that asks for anything possible."""
    if chance.random() < 0.2:
        return chance.randbytes(chance.randrange(120))
    data = packet(chance.choice(ADDRESSES), *chance.choices(VALUES, k=chance.randrange(6)))
    if chance.random() < 0.3:
        size = chance.choice([len(data), len(data), 0, -4, 3, 2**31 - 1])
        data = BUNDLE + chance.randbytes(8) + struct.pack(">i", size) + data
    return broken(data, chance)


def broken(data: bytes, chance: Random) -> bytes:
    kind = chance.random()
    if not data or kind < 0.3:
        return data
    at = chance.randrange(len(data))
    if kind < 0.5:
        return data[:at]
    if kind < 0.8:
        return data[:at] + chance.randbytes(1) + data[at + 1 :]
    return data[:at] + chance.randbytes(chance.randrange(1, 9)) + data[at:]


def dfmoco_bytes(chance: Random) -> bytes:
    if chance.random() < 0.1:
        return chance.randbytes(chance.randrange(200))
    words = [chance.choice(NAMES), *chance.choices(NUMBERS, k=chance.randrange(8))]
    data = chance.choice(LINES) if chance.random() < 0.3 else " ".join(words).encode("latin-1")
    if chance.random() < 0.01:
        data *= 3000
    return broken(data, chance) + chance.choice([b"\r\n", b"\r\n", b"\n", b"\r", b"", b"\0"])


def asks_by_osc(data: bytes) -> bool:
    """Whether python-osc finds a message for us in it, or cannot tell: it does not know the types c, S and I."""
    if re.search(rb",[^\0]*[cSI]", data):
        return True
    with suppress(Exception):
        return any(timed.message.address.startswith("/teleop/") for timed in OscPacket(_ending(data)).messages)
    return False


def _ending(data: bytes) -> bytes:
    """A packet up to the first element of negative size: python-osc goes back by it, and would never end."""
    at = len(BUNDLE) + 8
    while data.startswith(BUNDLE) and at + 4 <= len(data):
        (size,) = struct.unpack_from(">i", data, at)
        element = data[at + 4 : at + 4 + size] if size >= 0 else b""
        if size < 0 or _ending(element) != element:
            return data[:at]
        at += 4 + size
    return data


def osc_hunt(count: int, seed: int = 1) -> int:
    """How many of so many packets asked for something; asserts that python-osc saw a command in each of those."""
    logging.getLogger().setLevel(logging.ERROR)  # python-osc's own word on each
    chance = Random(seed)

    async def run() -> int:
        door, asked = FakeDoor(), 0
        outlet = Outlet(None)
        inlet = Inlet(Peers(door, "OSC", [], outlet.error), LIMITS, outlet)
        for number in range(count):
            data = osc_packet(chance)
            before = len(door.commands)
            inlet.datagram_received(data, ("127.0.0.1", 5))
            for _ in range(4):
                await asyncio.sleep(0)
            if len(door.commands) > before:
                asked += 1
                assert asks_by_osc(data), data
            if number % 40 == 39:
                await asyncio.sleep(0.001)
        return asked

    return asyncio.run(run())


def dfmoco_hunt(count: int, seed: int = 1) -> int:
    """How many of so many pieces moved something; asserts that a whole line in them was a command that does."""
    chance = Random(seed)

    async def run() -> int:
        door, moved = FakeDoor(), 0
        door.action_seconds = 0.0
        served = Served(door, Rig("fake", LIMITS, LIMITS), None, str)  # pyright: ignore[reportArgumentType]
        controller = Controller(served, motors_of(DfmocoSection(type="dfmoco", listen="tcp:[::1]:1"), LIMITS), str)
        client, reader, since = Client(door, "DFMoco 127.0.0.1", str), LineReader(), b""
        for _ in range(count):
            data = dfmoco_bytes(chance)
            since = (since + data)[-200_000:]
            before, client._bucket.level = len(door.commands), 50.0  # it is never too many
            for line in reader.feed(data):
                answers = await controller.do(client, line)
                assert all(re.fullmatch(r"[ -~]+", answer) for answer in answers), data
            if any(command["do"] in MOVES for command, *_ in door.commands[before:]):
                moved += 1
                assert MOVING.search(since), since
            if since.endswith((b"\r", b"\n")):
                since = b""
        return moved

    return asyncio.run(run())
