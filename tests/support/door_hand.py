"""A client of a door in a process of its own, as a gateway is: `python door_hand.py FOLDER WHAT [AMOUNT]`.

`hold`: takes control and holds pan over. `hang`: the same for a moment, then its sticks are silent and all else goes
on. `stretch`: the same, but from then on the network gives out nothing for half a second at a time, and then all of it.
`flood`: the same, and then sends AMOUNT of what is no command as fast as they leave. `stops`: presses STOP and clears
it AMOUNT times, and says how long each took to reach the loop, in ms. `gives` takes control, gives the command that is
AMOUNT as JSON, and then its page hangs. `floods` only floods, without a hand.
"""

from __future__ import annotations

import asyncio
import json
import os
import random
import sys
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import Any

from teleop.door.address import DoorAddress
from teleop.door.sockets import ClientSocket
from teleop.gateway.door_client import DoorClient

BEFORE = 0.7  # s that the stick is held before anything happens
OUTAGE = 0.5
PERIOD = 0.02
NEARLY = 59.0  # units/s: the bench's full speed is 60
ANNA, BOB = "anna", "bob"


def say(what: object) -> None:
    sys.stdout.write(f"{what}\n")
    sys.stdout.flush()


async def hold(door: DoorClient, what: str) -> None:
    await door.command({"do": "take_control"}, ANNA, "Anna")
    begin, seq, kept, zeros, moved = monotonic(), 0, [], 3, False
    say("holding")
    while True:
        now = monotonic()
        door.seen(ANNA)
        state = door.state()
        if not moved and state["axes"]["pan"]["speed"] > NEARLY:
            moved = True
            say("moved")
        if not moved and "again" in state["sticks"]["waits_for"]:  # a machine under load: nothing has been tested yet
            await door.command({"do": "take_control"}, ANNA, "Anna")
            begin, zeros = now, seq + 3
        message = {"seq": seq, "time": now * 1000, "axes": {"pan": 0.0 if seq < zeros else 1.0}}
        seq += 1
        if what == "hang" and now - begin > BEFORE:
            await asyncio.sleep(PERIOD)
            continue
        kept.append(message)
        out = what == "stretch" and now - begin > BEFORE and (now - begin - BEFORE) % (2 * OUTAGE) < OUTAGE
        if not out:
            for each in kept:
                door.stick(each, ANNA)
            kept.clear()
        await asyncio.sleep(PERIOD)


def flood(folder: Path, amount: int) -> None:
    """In a thread: of every length, some of them nearly commands."""
    chance = random.Random(1)
    socket = ClientSocket(str(folder / "flood"), DoorAddress(folder).commands)
    socket.setblocking(True)
    begins = [b"", b"\x82\xa2do\xa4stop", b"\x83\xa2do\xa5stick\xa2id\x00", b"\xdf\xff\xff\xff\xff", b"\x91" * 40]
    for _ in range(amount):
        with suppress(OSError):
            socket.send(chance.choice(begins) + chance.randbytes(chance.randrange(60)))
    say("flooded")


async def gives(door: DoorClient, command: dict[str, Any]) -> None:
    await door.command({"do": "take_control"}, ANNA, "Anna")
    accepted = await door.command(command, ANNA, "Anna")
    assert "ok" in accepted, accepted
    say("holding")
    await asyncio.sleep(3600)


async def stops(door: DoorClient, amount: int) -> None:
    say("holding")
    for _ in range(amount):
        before = monotonic()
        answer = await door.command({"do": "stop"}, BOB, "Bob")
        assert "ok" in answer, answer
        while not door.state()["stopped"]:
            await asyncio.sleep(0.0005)
        say(round(1000 * (door.state()["time"] - before), 2))
        await door.command({"do": "clear"}, ANNA, "Anna")
        while door.state()["stopped"]:
            await asyncio.sleep(0.001)
        await asyncio.sleep(0.0137)


async def main(folder: Path, what: str, given: str) -> None:
    async with DoorClient(DoorAddress(folder)) as door:
        if what == "gives":
            await gives(door, json.loads(given))
            return
        amount = int(given)
        if what == "stops":
            await stops(door, amount)
            return
        if what == "floods":
            say("holding")
            await asyncio.to_thread(flood, folder, amount)
            return
        if what == "flood":
            asyncio.get_running_loop().call_later(
                BEFORE, lambda: asyncio.ensure_future(asyncio.to_thread(flood, folder, amount))
            )
        await hold(door, what)


if __name__ == "__main__":
    os.setpgid(0, 0)
    asyncio.run(main(Path(sys.argv[1]), sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "0"))
