"""What DFMoco's commands do with a rig, on its virtual clock."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from door_rig import settled, with_rig
from fake_door import FakeDoor
from remote_bench import RemoteBench

from teleop.config.exchange.dfmoco import DfmocoSection
from teleop.core.axes import Axis, Limits
from teleop.exchange.client import Client
from teleop.exchange.dfmoco.controller import Controller
from teleop.exchange.dfmoco.lines import parsed
from teleop.exchange.dfmoco.motors import motors_of
from teleop.exchange.served import Rig, Served
from teleop.gateway.door_client import DoorClient


class Bench:
    """`ask` gives a line and returns its answers, as one text; `said` are lines for the operator."""

    def __init__(self, door: DoorClient, rig: RemoteBench) -> None:
        self.said: list[str] = []
        limits = {axis: rig.hands._limits[axis] for axis in rig.hands._limits}
        served = Served(door, Rig("bench", limits, limits), None, self.said.append)
        section = DfmocoSection(type="dfmoco", listen="tcp:127.0.0.1:0")
        self.door, self.rig = door, rig
        self.controller = Controller(served, motors_of(section, limits), self.said.append)
        self.client = Client(door, "DFMoco 10.0.0.2", self.said.append)

    async def ask(self, line: str, client: Client | None = None) -> str:
        command = parsed(line.encode())
        assert command is not None
        return ", ".join(await self.controller.do(client or self.client, command))

    async def rests(self) -> None:
        while await self.ask("ms") != "ms 0000":
            await asyncio.sleep(0.001)

    def fastest(self, axis: str) -> float:
        return abs(self.door.state()["axes"][axis]["speed"])


Work = Callable[[Bench], Awaitable[None]]


def on_rig(folder: Path, work: Work) -> None:
    async def run(door: DoorClient, rig: RemoteBench) -> None:
        await settled(lambda: door.state() and door.state()["axes"]["pan"]["measured"] is not None)
        await work(Bench(door, rig))

    with_rig(folder, run)


def test_each_motor_goes_its_own_way_at_its_own_rate(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        assert await bench.ask("pr 1 8000") == "pr 1 8000"
        assert await bench.ask("pr 2 50") == "pr 2 100"
        assert await bench.ask("pr 2 99999") == "pr 2 20000"
        assert await bench.ask("mm 1 20000") == "mm 1 20000"
        assert await bench.ask("mm 2 9000") == "mm 2 9000"
        fastest = {"pan": 0.0, "tilt": 0.0}
        while await bench.ask("ms") != "ms 0000":
            fastest = {axis: max(speed, bench.fastest(axis)) for axis, speed in fastest.items()}
            await asyncio.sleep(0)
        assert fastest == {"pan": pytest.approx(8, abs=0.05), "tilt": pytest.approx(20, abs=0.5)}
        assert (await bench.ask("mp 1"), await bench.ask("mp 2")) == ("mp 1 20000", "mp 2 9000")

    on_rig(tmp_path, work)


def test_one_motor_stops_and_the_other_goes_on(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        await bench.ask("pr 1 20000")
        await bench.ask("mm 1 40000")
        await bench.ask("mm 2 4000")
        await settled(lambda: bench.fastest("tilt") > 4)
        stopped = await bench.ask("sm 2")
        assert stopped.startswith("sm 2, mp 2 ")
        await settled(lambda: bench.fastest("tilt") == 0)
        assert await bench.ask("ms") == "ms 1000"
        await bench.rests()
        assert await bench.ask("mp 1") == "mp 1 40000"
        assert int((await bench.ask("mp 2")).split()[2]) < 4000

    on_rig(tmp_path, work)


def test_a_go_motion_of_two_motors_passes_their_places_together(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        assert await bench.ask("bf 1000 500 1 900 1000 1100 2 -200 0 400") == "bf 1000"
        assert await bench.ask("go") == "parse error"  # it is on its way to the start
        await bench.rests()
        assert (await bench.ask("mp 1"), await bench.ask("mp 2")) == ("mp 1 900", "mp 2 -200")
        assert await bench.ask("go") == "go"
        assert await bench.ask("bf 1000 500 1 0 100 200") == "parse error"
        await bench.rests()
        assert (await bench.ask("mp 1"), await bench.ask("mp 2")) == ("mp 1 1100", "mp 2 400")
        assert await bench.ask("go") == "parse error"  # it needs a start again

    on_rig(tmp_path, work)


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("bf 1000 500 1 0 100", "parse error"),
        ("bf 1000 500 9 0 100 200", "parse error"),
        ("bf 0 500 1 0 100 200", "parse error"),
        ("bf 1000 1001 1 0 100 200", "parse error"),
        ("bf 10 1000 1 0 5000 10000", "bf -1"),  # faster than the axis may
        ("bf 1000 500 1 179000 179990 181000", "bf -1"),
        ("bf 1000 500 3 0 100 200", "bf -1"),  # the rig has no roll
        ("mm 3 100", "mp 3 0"),
        ("mm 1 180001", "mp 1 0"),
        ("mm 1 -2147483647", "mp 1 0"),
        ("mm 1 1 1", "parse error"),
        ("mm 0 1", "parse error"),
        ("mm 5 1", "parse error"),
        ("mm -1 1", "parse error"),
        ("jm 1 100 10001", "parse error"),
        ("jm 1 100 -1", "parse error"),
        ("jm 3 100", "jm 3"),
        ("im 3 100", "im 3"),
        ("sm 7", "parse error"),
        ("pr 1", "parse error"),
        ("np 1", "parse error"),
        ("zm", "parse error"),
        ("go", "parse error"),
    ],
)
def test_what_is_refused_stays(tmp_path: Path, line: str, answer: str) -> None:
    async def work(bench: Bench) -> None:
        assert await bench.ask(line) == answer
        assert await bench.ask("ms") == "ms 0000"
        assert all(not axis["speed"] for axis in bench.door.state()["axes"].values())

    on_rig(tmp_path, work)


def test_an_inch_is_two_steps_and_a_new_number_moves_nothing(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        for _ in range(5):
            assert await bench.ask("im 1 100") == "im 1"
        await bench.rests()
        assert await bench.ask("mp 1") == "mp 1 10"
        assert await bench.ask("np 1 500") == "mp 1 500"
        assert await bench.ask("im 1 501") == "im 1"
        await bench.rests()
        assert await bench.ask("mp 1") == "mp 1 501"
        assert await bench.ask("zm 1") == "mp 1 0"
        assert bench.controller.due() == ["mp 1 0"]
        assert bench.controller.due() == []
        assert bench.door.state()["axes"]["pan"]["commanded"] == pytest.approx(0.011, abs=1e-4)

    on_rig(tmp_path, work)


def test_a_jog_ends_by_itself_and_turns_only_after_it_has_stopped(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        assert await bench.ask("jm 1 100000 5000") == "jm 1"
        await settled(lambda: bench.fastest("pan") > 2.4)
        assert await bench.ask("jm 1 -100000 5000") == "jm 1"  # it stops first
        await bench.rests()
        assert 0 < int((await bench.ask("mp 1")).split()[2]) < 2500
        assert await bench.ask("jm 1 -100000") == "jm 1"
        await bench.rests()
        assert int((await bench.ask("mp 1")).split()[2]) < 0
        await bench.ask("jm 1 -100000 0")
        assert await bench.ask("ms") == "ms 0000"

    on_rig(tmp_path, work)


def test_a_stop_of_all_ends_its_own_ways_and_is_a_stop_for_anothers(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        await bench.ask("mm 1 90000")
        await settled(lambda: bench.fastest("pan") > 1)
        assert await bench.ask("sa") == "sa"
        await bench.rests()
        assert not bench.door.state()["stopped"]
        await bench.door.command({"do": "take_control"}, "s1", "Anna")
        await bench.door.command({"do": "goto", "axes": {"pan": 90.0}, "seconds": 10.0}, "s1", "Anna")
        await settled(lambda: bench.fastest("pan") > 1)
        assert (await bench.ask("mm 1 0")).startswith("mp 1 ")
        assert any("Anna has control" in line for line in bench.said)
        assert (await bench.ask("sm 1")).startswith("sm 1")  # a jog that was refused, and is let go
        assert not bench.door.state()["stopped"]
        await bench.ask("sa")
        await settled(lambda: bench.door.state()["stopped"])
        assert bench.door.state()["stopped_by"] == "DFMoco 10.0.0.2"

    on_rig(tmp_path, work)


def test_one_that_is_not_allowed_reads_and_stops_and_does_no_more(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        stranger = Client(bench.door, "DFMoco 10.9.9.9", print, allowed=False)
        assert await bench.ask("hi", stranger) == "hi 2 4 2.0.0"
        for line in ("mm 1 1000", "np 1 5", "zm 1", "mp 1"):
            assert await bench.ask(line, stranger) == "mp 1 0"
        assert await bench.ask("pr 1 300", stranger) == "pr 1 5000"
        assert await bench.ask("bf 1000 500 1 0 100 200", stranger) == "bf -1"
        assert await bench.ask("go") == "parse error"  # a stranger has prepared nothing
        await bench.ask("jm 1 1000", stranger)
        assert bench.rig.at() == 0
        await bench.ask("mm 1 90000")
        await settled(lambda: bench.fastest("pan") > 1)
        assert await bench.ask("sa", stranger) == "sa"
        await bench.rests()

    on_rig(tmp_path, work)


def test_a_jog_does_not_outlive_its_connection_and_a_move_does(tmp_path: Path) -> None:
    async def work(bench: Bench) -> None:
        await bench.ask("jm 1 100000")
        await settled(lambda: bench.fastest("pan") > 1)
        await bench.controller.gone(bench.client)
        await bench.rests()
        await settled(lambda: bench.door.state()["holder"] is None)
        other = Client(bench.door, "DFMoco 10.0.0.3", print)
        await bench.ask("mm 1 3000", other)
        await bench.controller.gone(other)
        await bench.rests()
        assert await bench.ask("mp 1") == "mp 1 3000"
        await settled(lambda: bench.door.state()["holder"] is None)

    on_rig(tmp_path, work)


def test_nothing_but_hi_and_ms_is_answered_before_the_first_reading() -> None:
    async def run() -> None:
        door = FakeDoor()
        door.positions = dict.fromkeys(door.positions)  # pyright: ignore[reportAttributeAccessIssue]
        section = DfmocoSection(type="dfmoco", listen="tcp:127.0.0.1:0")
        limits = {Axis.PAN: Limits(-180.0, 180.0, 60.0, 240.0, 2400.0)}
        served = Served(door, Rig("fake", limits, limits), None, print)  # pyright: ignore[reportArgumentType]
        controller = Controller(served, motors_of(section, limits), print)
        client = Client(door, "DFMoco 10.0.0.2", print)
        for line, answer in ((b"hi", ["hi 2 4 2.0.0"]), (b"ms", ["ms 0000"]), (b"mp 1", ()), (b"mm 1 5", ())):
            command = parsed(line)
            assert command is not None
            assert await controller.do(client, command) == answer
        assert not controller.due()
        assert not door.commands

    asyncio.run(run())
