"""An entry that fails is served again, after pauses that grow until it has worked."""

from __future__ import annotations

import asyncio
from dataclasses import astuple, replace
from types import SimpleNamespace

import pytest
from fake_served import LIMITS, FakeServed

from teleop.config.exchange.foxglove import FoxgloveSection
from teleop.core.errors import DeviceError
from teleop.exchange import serving
from teleop.exchange.served import Served


class VirtualLoop(asyncio.SelectorEventLoop):
    """Its clock goes on by what it would have waited."""

    def __init__(self) -> None:
        super().__init__()
        self._elapsed = 0.0
        real = self._selector.select  # type: ignore[attr-defined]

        def select(timeout: float | None) -> list:
            self._elapsed += timeout or 0.0
            return real(0)

        self._selector.select = select  # type: ignore[attr-defined]

    def time(self) -> float:
        return self._elapsed


class Failing:
    """A server that works for so many seconds, then fails; it returns once all its lives are over."""

    def __init__(self, *lives: float) -> None:
        self.lives = list(lives)
        self.begun: list[float] = []

    async def serve(self, section: object, served: object) -> None:
        self.begun.append(asyncio.get_running_loop().time())
        if self.lives:
            await asyncio.sleep(self.lives.pop(0))
            raise DeviceError("the port is gone")


def pauses_of(*lives: float, monkeypatch: pytest.MonkeyPatch) -> tuple[list[float], list[str]]:
    """The pause after each life, and what was said."""
    server, said = Failing(*lives), []
    monkeypatch.setattr(serving, "importlib", SimpleNamespace(import_module=lambda _: server))
    served = replace(FakeServed().served, notify=said.append)
    entry = FoxgloveSection(type="foxglove", listen="127.0.0.1:0")
    loop = VirtualLoop()
    loop.run_until_complete(serving._kept(entry, served))
    loop.close()
    ends = [begun + life for begun, life in zip(server.begun, lives, strict=False)]
    return [round(begun - end, 6) for begun, end in zip(server.begun[1:], ends, strict=True)], said


def test_the_pauses_grow_and_the_same_reason_is_said_once(monkeypatch: pytest.MonkeyPatch) -> None:
    pauses, said = pauses_of(*8 * [0.0], monkeypatch=monkeypatch)
    assert pauses == [1, 2, 4, 8, 16, 30, 30, 30]
    assert said == ["exchange foxglove: the port is gone: tried again until it works"]


def test_an_entry_that_has_worked_for_a_minute_is_served_again_soon_and_its_failure_is_said_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pauses, said = pauses_of(0.0, 0.0, 0.0, 59.0, 60.0, 0.0, monkeypatch=monkeypatch)
    assert pauses == [1, 2, 4, 8, 1, 2]
    assert len(said) == 2


def test_what_moves_the_rig_is_given_the_axes_of_the_run_once_there_is_a_state(monkeypatch: pytest.MonkeyPatch) -> None:
    """A move of pan alone: a fader or a motor of tilt would look for an axis that no state has."""
    fake, given = FakeServed(), list[Served]()

    class Server:
        async def serve(self, _section: object, served: Served) -> None:
            given.append(served)

    async def run() -> None:
        work = asyncio.ensure_future(serving.serve(settings, served.door))
        await asyncio.sleep(3 * serving.LOOK)
        assert not given
        fake.door.measure(pan=0.0)
        await work

    monkeypatch.setattr(serving, "importlib", SimpleNamespace(import_module=lambda _: Server()))
    served = fake.served
    limits = {axis.value: astuple(of) for axis, of in LIMITS.items()}
    entry = {"type": "foxglove", "listen": "127.0.0.1:0"}
    settings = {"entries": [entry], "listeners": [None], "rig": {"name": "rig", "limits": limits}}
    asyncio.run(run())
    assert [sorted(served.rig.limits) for served in given] == [["pan", "tilt"]]
    assert [sorted(served.rig.moved) for served in given] == [["pan"]]
