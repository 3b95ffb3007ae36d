"""A commissioning with a door on the virtual clock: clients send real datagrams, and their keys move the bench."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from random import Random
from typing import Any

import msgpack
from commission_bench import CommissionBench
from drone_commission_bench import DroneCommissionBench

from teleop.commission.page import GO, STOP, Stage
from teleop.door.messages import packed
from teleop.door.ring import RingReader
from teleop.door.sockets import ClientSocket
from teleop.door.states import StateUnpacker
from teleop.remote.commission_hands import CommissionHands
from teleop.sim.gimbal.device import SimulatedGimbal

ANNA, BOB = "anna", "bob"
ALIVE = 0.2  # s between two words of the gateway
LONGEST = 1500.0  # s
KEYS = ["enter", "s", "r", "q", "y", "n", "space", "left", "L", "1", "x", ""]
FIELDS: list[Any] = [None, True, -1, 0, 1, 2**53, 1e300, "", "enter", "x" * 60, [], {}, "\x00", "props off"]


class CommissionDoor:
    """Answers are kept by the id of their command, and how each action ended in `ends`.

    `seen` are the pages that live; `quiet` is a gateway that says nothing any more.
    """

    def __init__(self, bench: CommissionBench | DroneCommissionBench, hands: CommissionHands) -> None:
        self.bench, self.hands, self.runner = bench, hands, bench.runner
        self.answers: dict[int, dict[str, Any]] = {}
        self.ends: dict[int, dict[str, Any]] = {}
        self.seen: dict[str, float] = {ANNA: 0.0}
        self.quiet = False
        self._ids = itertools.count(1)
        self._told = -1.0
        self._reader, self._unpacker = RingReader(hands.door.address.ring), StateUnpacker()
        self._socket = ClientSocket(hands.door.address.client(1), hands.door.address.commands)

    def close(self) -> None:
        self._socket.close()
        self._reader.close()

    @property
    def gimbal(self) -> SimulatedGimbal:
        assert isinstance(self.bench, CommissionBench)
        return self.bench.gimbal

    @property
    def now(self) -> float:
        return self.bench.clock.now()

    @property
    def state(self) -> dict[str, Any]:
        newest = self._reader.newest()
        assert newest is not None
        return self._unpacker.unpack(newest.data)

    @property
    def page(self) -> dict[str, Any]:
        return self.state["commission"]

    def send(self, data: bytes) -> None:
        self._socket.send(data)

    def say(self, do: str, session: str = ANNA, **fields: Any) -> int:
        number = next(self._ids)
        self.send(packed({"do": do, "id": number, "session": session, "person": session.title(), **fields}))
        return number

    def turn(self, *local: str) -> None:
        """One turn, with keys of the terminal."""
        if not self.quiet and self.now - self._told >= ALIVE:
            self._told = self.now
            self.say("alive", "gateway", seen=self.seen)
        now = self.now
        self.bench.turn(*self.hands.keys(now, local))
        self.hands.show(now)
        while True:
            try:
                answer = msgpack.unpackb(self._socket.recv(4096))
            except BlockingIOError:
                return
            (self.ends if answer.get("done") else self.answers)[answer["id"]] = answer

    def ask(self, do: str, session: str = ANNA, **fields: Any) -> dict[str, Any]:
        number = self.say(do, session, **fields)
        self.turn()
        return self.answers[number]

    def press(self, key: str, session: str = ANNA, **fields: Any) -> dict[str, Any]:
        """On the page as it is now."""
        return self.ask("commission_key", session, page=self.page["page"], key=key, **fields)

    def run(self, seconds: float) -> None:
        end = self.now + seconds
        while self.now < end - 1e-6:
            self.turn()

    def until(self, stage: Stage, step: str = "") -> dict[str, Any]:
        """The page of that stage."""
        end = self.now + 60
        while self.runner.stage is not stage or (step and self.page["key"] != step):
            assert self.now < end, self.page
            self.turn()
        return self.page

    def to_the_first_move(self) -> None:
        """The page of pan's position command, with Anna in control."""
        assert self.ask("take_control")["ok"]
        self.until(Stage.PROMPT)
        self.press(GO)
        self.press("y")
        self.until(Stage.SHOWN)
        self.run(0.1)  # two Enters are further apart than those of a key that is held
        self.press(GO)
        while self.page["key"] != "position-pan":
            assert self.press("s")["ok"]

    def operated(self) -> None:
        """To the end, every key of the bench's operator pressed by Anna in her browser."""
        self.ask("take_control")
        end = self.now + LONGEST
        while not self.runner.over:
            assert self.now < end, self.page
            page = self.runner.page
            keys = self.bench.operator.keys(page, self.now)
            if not keys:
                self.turn()
            elif page.typed is not None:
                assert self.press(GO, text="".join(key for key in keys if len(key) == 1 and key != "x"))["ok"]
            elif keys == [STOP]:
                assert self.ask("stop")["ok"]
            else:
                answer = self.press(keys[0], ANNA, agrees=bool(page.consent))
                assert "ok" in answer, (answer, page)


@contextmanager
def commission_door(bench: CommissionBench | DroneCommissionBench) -> Iterator[CommissionDoor]:
    with ExitStack() as stack:
        device = "gimbal" if isinstance(bench, CommissionBench) else "drone"
        made = bench.made.bench if isinstance(bench, CommissionBench) else bench.bench
        hands = CommissionHands(bench.runner, "Bench", device, lambda: made.connection, None)
        hands.open(stack, bench.clock)
        door = CommissionDoor(bench, hands)
        stack.callback(door.close)
        door.turn()
        yield door


def fuzzed(door: CommissionDoor, amount: int, seed: int = 1) -> int:
    """How many of so many datagrams of a stranger were no commands; asserts that no fault and no key came of any."""
    chance = Random(seed)
    desk, number = door.hands.desk, door.page["page"]
    for _ in range(amount):
        message: dict[str, Any] = {
            "do": chance.choice(
                ["commission_key"] * 8 + ["goto", "jog", "play", "record", "shoot", "recenter", "stick"]
            ),
            "id": chance.randrange(10**6),
            "session": chance.choice(["eve", "mallory"]),
            "page": chance.choice([number, number, number - 1, number + 1, *FIELDS]),
            "key": chance.choice([*KEYS, *FIELDS]),
        }
        for name in chance.sample(
            ["text", "agrees", "axes", "seconds", "do", "brief", "page"], chance.choice([0, 0, 1])
        ):
            message[name] = chance.choice(FIELDS) if name != "brief" else False
        data = msgpack.packb(message) or b""
        door.send(data[: chance.randrange(len(data))] if chance.random() < 0.2 else data)
        if _ % 8 == 7:
            door.turn()
            assert desk.counts.faults == 0, message
            assert door.page["page"] == number, message
    return desk.counts.malformed
