"""Datagrams that no tracker sends: noise, and messages and samples with some of it wrong, some of them still valid."""

from __future__ import annotations

import json
import math
import random
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from copy import deepcopy
from pathlib import Path
from typing import Any, cast

import cbor2
from fake_served import FakeServed
from remote_bench import ANNA, RemoteBench, remote_bench

from teleop.config.exchange.freed import FreeDSection
from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.core.axes import Axis
from teleop.core.timing import PERIOD
from teleop.door.messages import packed
from teleop.exchange import following
from teleop.exchange.following import Follower
from teleop.exchange.freed.codec import D1, encode
from teleop.exchange.freed.following import FreeDFollower
from teleop.exchange.opentrackio.following import OpenTrackIOFollower
from teleop.exchange.opentrackio.packets import CBOR, JSON, fletcher16, packets
from teleop.exchange.opentrackio.sample import Moment, Pose, Source, identity, sample

PEERS = ("127.0.0.1", "127.0.0.2", "192.168.1.20", "::1", "fe80::1%eth0", "10.0.0.1")
VALUES: list[Any] = [None, True, -1, 0, 1e308, 2**70, "", "x", [], {}, [[]], "NaN", float("inf"), float("nan"), 5.0]
SOURCE = Source(1, identity("a", "b", 1), 50.0, "rig", "1")


def freed_message(chance: random.Random) -> bytes:
    if chance.random() < 0.2:
        return chance.randbytes(chance.choice([0, 1, 28, 29, 29, 30, 58]))
    pan, tilt, roll, x, y, z = (chance.uniform(-400, 400) for _ in range(6))
    data = bytearray(encode(D1(chance.choice([1, 1, 2]), pan, tilt, roll, x, y, z)))
    for _ in range(chance.choice([0, 0, 1, 3])):
        data[chance.randrange(29)] = chance.randrange(256)
    if chance.random() < 0.7:
        data[28] = (chance.choice([0x40, 0x100]) - sum(data[:28])) & 0xFF
    return bytes(data[: chance.randrange(30)]) if chance.random() < 0.1 else bytes(data)


def opentrackio_packet(chance: random.Random) -> bytes:
    if chance.random() < 0.1:
        return chance.randbytes(chance.randrange(80))
    encoding = chance.choice([JSON, CBOR])
    made = sample(SOURCE, Moment(1.0, 1, True), Pose(*(chance.uniform(-9, 9) for _ in range(6))), 0.5, "x", False)
    for _ in range(chance.choice([0, 0, 1, 2])):
        _spoil(made, chance)
    payload = json.dumps(made).encode() if encoding == JSON else _cbor(made)
    if chance.random() < 0.2:
        payload = _damaged(payload, chance)
    data = bytearray(
        chance.choice(list(packets(payload, encoding, chance.randrange(65536), chance.choice([64, 1400]))))
    )
    if chance.random() < 0.3:
        data[chance.randrange(16)] = chance.randrange(256)
        if chance.random() < 0.5:
            data[14:16] = fletcher16(bytes(data[:14] + data[16:]))
    return bytes(data)


def _spoil(made: dict[str, Any], chance: random.Random) -> None:
    part: Any = made
    while True:
        key = chance.choice(list(part) if isinstance(part, dict) else range(len(part))) if part else None
        if key is None:
            return
        if not isinstance(part[key], dict | list) or chance.random() < 0.2:
            part[key] = deepcopy(chance.choice(VALUES))
            return
        part = part[key]


def _cbor(made: Mapping[str, Any]) -> bytes:
    return cbor2.dumps(dict(made))


def _damaged(payload: bytes, chance: random.Random) -> bytes:
    data = bytearray(payload)
    for _ in range(chance.choice([1, 5])):
        data[chance.randrange(len(data))] = chance.randrange(256)
    return bytes(data) + chance.choice([b"", b"[" * 2000, chance.randbytes(20)])


@contextmanager
def by_the_bench(bench: RemoteBench) -> Iterator[None]:
    """Followers live by the bench's clock."""
    clock, following.monotonic = following.monotonic, lambda: bench.now
    try:
        yield
    finally:
        following.monotonic = clock


class _Door:
    """Passes aims on to the bench, as the gateway does."""

    def __init__(self, bench: RemoteBench) -> None:
        self._bench = bench
        self.aims = 0

    def aim(self, source: int, axes: Mapping[str, float], time: float) -> None:
        self.aims += 1
        message = {"do": "aim", "id": 0, "session": "gateway", "time": time * 1000, "source": source, "axes": axes}
        self._bench.send(packed(message))


def fuzzed(folder: Path, amount: int, seed: int = 1, tracks: bool = False) -> int:
    """How many of so many datagrams were aimed at; asserts that nothing raised, and nothing moved.

    With `tracks` a client follows them, as wild as they are: then nothing is beyond a limit.
    """
    chance = random.Random(seed)
    with remote_bench(folder) as bench, by_the_bench(bench):
        door, served = _Door(bench), FakeServed()
        given = served.served.__class__(cast(Any, door), served.served.rig, None, served.lines.append, 1)
        both: list[tuple[Follower, Callable[[random.Random], bytes]]] = [
            (FreeDFollower(FreeDSection.model_validate(_listening("freed")), given, "a"), freed_message),
            (
                OpenTrackIOFollower(OpenTrackIOSection.model_validate(_listening("opentrackio")), given, "b"),
                opentrackio_packet,
            ),
        ]
        speed: dict[Axis, float] = {Axis.PAN: 0.0, Axis.TILT: 0.0}
        for number in range(amount):
            follower, make = both[number % 2]
            follower.datagram_received(make(chance), (chance.choice(PEERS), 5000))
            if number % 4 == 3:
                if tracks and number % 400 == 3:
                    _track(bench)
                bench.tick()
                assert bench.hands.desk.counts.faults == 0
                assert not bench.loop.faults
                _assert_legal(bench, speed)
        if not tracks:
            assert bench.at() == 0.0
            assert bench.at(Axis.TILT) == 0.0
        return door.aims


def _listening(kind: str) -> dict[str, Any]:
    return {"type": kind, "listen": "127.0.0.1:1", "as": "target", "allow": ["192.168.1.0/24"]}


def _track(bench: RemoteBench) -> None:
    bench.seen[ANNA] = 0.0
    bench.say("take_control")
    bench.say("track")


def _assert_legal(bench: RemoteBench, before: dict[Axis, float]) -> None:
    for axis, limits in bench.hands._limits.items():
        at = bench.state["axes"][axis.value]
        assert limits.minimum <= at["commanded"] <= limits.maximum
        assert abs(at["speed"]) <= limits.velocity * 1.0001
        assert abs(at["speed"] - before[axis]) <= limits.acceleration * PERIOD * 1.01
        assert math.isfinite(at["commanded"])
        before[axis] = at["speed"]
