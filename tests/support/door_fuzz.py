"""Datagrams made at random: of bytes, of maps, and of commands with a field or two that are wrong."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import msgpack
from remote_bench import remote_bench

from teleop.core.axes import Axis
from teleop.door.messages import SHAPES

VALUES: list[Any] = [None, True, False, -1, 0, 1, 7, 2**53, 1e300, float("nan"), "", "pan", "keys", "reveal", "x" * 300]
VALUES += [b"\xff", [], [1], {}, {"pan": 0.5}, {"pan": 5.0, "tilt": -1.0}, {"pan": "x"}, {1: 2}, {"a": {"b": 1}}]
FIELDS = sorted({name for shape in SHAPES.values() for name in (*shape.required, *shape.optional)})
OPEN = ("take_control", "clear")  # who gives these to themselves may move the rig


def datagram(chance: random.Random) -> bytes:
    if chance.random() < 0.3:
        return chance.randbytes(chance.randrange(80))
    do = chance.choice([each for each in SHAPES if each not in OPEN] + ["fly", ""])
    shape = SHAPES.get(do)
    known = [] if shape is None else [*shape.required, *shape.optional]
    message: dict[Any, Any] = {"do": do, "id": chance.randrange(10**6), "session": "eve"}
    for name in (*known, *chance.sample(FIELDS, chance.choice([0, 0, 1]))):
        message[name] = chance.choice(VALUES)
    if chance.random() < 0.2:
        message[chance.choice(["id", "session", "person", "time", "do"])] = chance.choice(VALUES)
    data = msgpack.packb(message) or b""
    return data[: chance.randrange(len(data))] if chance.random() < 0.2 else data


def fuzzed(folder: Path, amount: int, seed: int = 1) -> int:
    """How many of so many datagrams were no commands; asserts that no fault and no motion came of any."""
    chance = random.Random(seed)
    with remote_bench(folder) as bench:
        desk = bench.hands.desk
        for number in range(amount):
            data = datagram(chance)
            bench.send(data)
            if number % 8 == 7:
                bench.tick()
                assert desk.counts.faults == 0, data
                assert not bench.loop.faults, data
                assert not bench.operator.status.deflections, data
        bench.tick(50)
        state = bench.state
        assert all(state["axes"][axis]["commanded"] == 0 for axis in (Axis.PAN, Axis.TILT))
        assert state["holder"] is None
        return desk.counts.malformed
