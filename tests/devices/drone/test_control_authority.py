"""Control obtained and released: each order is sent until it is confirmed (docs/protocol-facts.md, 01 00)."""

from __future__ import annotations

import math

import pytest
from fake_drone_link import FakeConnection, FakeTelemetry

from teleop.devices.drone.control_authority import ControlAuthority
from teleop.dji.drone.broadcast_parts import ControlSource
from teleop.dji.drone.enums import ControlCode, ControlDevice, ControlOrder, CurrentMode
from teleop.dji.drone.messages import Control, ControlAck

OBTAIN, RELEASE = Control(ControlOrder.OBTAIN), Control(ControlOrder.RELEASE)


class Bench:
    def __init__(self) -> None:
        self.link, self.seen, self.messages = FakeConnection(), FakeTelemetry(), list[str]()
        self.authority = ControlAuthority(self.link.real, self.messages.append)
        self.now = 10.0

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds * 100)):
            self.now += 0.01
            self.authority.service(self.now)

    def broadcast(self, device: ControlDevice) -> None:
        """The drone says from now on who controls it."""
        self.seen.parts = {"control": ControlSource(CurrentMode.ATTI_STOP, device)}
        self.seen.since = self.now

    @property
    def held(self) -> bool | None:
        return self.authority.held(self.seen.real, self.now)


@pytest.mark.parametrize(("order", "in_progress", "done", "held"), [(OBTAIN, 3, 2, True), (RELEASE, 4, 1, False)])
def test_an_order_is_sent_again_while_it_is_in_progress(
    order: Control, in_progress: int, done: int, held: bool
) -> None:
    bench = Bench()
    (bench.authority.obtain if order is OBTAIN else bench.authority.release)(bench.now)
    bench.run(1.0)
    assert bench.link.requests == [order], "not before it is answered"
    bench.link.answer(ControlAck(in_progress))
    bench.run(0.15)
    assert bench.link.requests == [order] * 2
    bench.link.answer(ControlAck(done))
    bench.run(5.0)
    assert bench.link.requests == [order] * 2
    assert (bench.held, bench.messages) == (held, [])


def test_no_answer_is_told_and_asked_again() -> None:
    bench = Bench()
    bench.authority.obtain(bench.now)
    bench.link.answer(None)
    bench.run(0.6)
    assert bench.messages == ["the drone did not answer when asked about control"]
    assert bench.link.requests == [OBTAIN] * 2


def test_a_refusal_ends_the_wait_and_is_not_asked_again() -> None:
    bench = Bench()
    bench.authority.obtain(bench.now)
    assert bench.authority.patience == 3.0
    bench.link.answer(ControlAck(ControlCode.NOT_IN_F_MODE))
    bench.run(5.0)
    assert (bench.authority.patience, bench.link.requests) == (0.0, [OBTAIN])
    assert bench.messages == ["the drone refuses control: not in f mode"]


def test_releasing_goes_on_whatever_is_answered() -> None:
    bench = Bench()
    bench.authority.release(bench.now)
    for _ in range(3):
        bench.link.answer(ControlAck(ControlCode.NOT_IN_F_MODE))
        bench.run(0.6)
    assert bench.link.requests == [RELEASE] * 4


def test_a_late_answer_to_an_older_order_is_none() -> None:
    bench = Bench()
    bench.authority.obtain(bench.now)
    bench.authority.release(bench.now)
    bench.link.answer(ControlAck(2), sequence=0)
    bench.link.answer(ControlAck(1), sequence=0)
    assert bench.held is None


def test_whoever_leaves_asks_no_more() -> None:
    bench = Bench()
    bench.authority.obtain(bench.now)
    bench.link.answer(ControlAck(3))
    bench.authority.cancel()
    bench.run(5.0)
    assert (bench.link.requests, bench.link.withdrawn) == ([OBTAIN], {Control})


def test_what_the_drone_broadcasts_decides_once_it_came_after_the_order() -> None:
    bench = Bench()
    bench.broadcast(ControlDevice.ONBOARD_DEVICE)
    bench.run(0.5)
    bench.authority.release(bench.now)
    bench.run(0.1)
    assert bench.held is None, "it came before the release"
    bench.broadcast(ControlDevice.ONBOARD_DEVICE)
    assert bench.held is True
    assert bench.authority.still_held(bench.seen.real, bench.now)
    bench.broadcast(ControlDevice.REMOTE_CONTROLLER)
    assert bench.held is False
    assert not bench.authority.still_held(bench.seen.real, bench.now)


def test_movement_is_obeyed_as_soon_as_either_says_so() -> None:
    bench = Bench()
    assert not bench.authority.obtained(bench.seen.real, math.inf)
    bench.authority.obtain(bench.now)
    bench.run(0.1)
    assert not bench.authority.obtained(bench.seen.real, bench.now)
    bench.broadcast(ControlDevice.ONBOARD_DEVICE)
    assert bench.authority.obtained(bench.seen.real, bench.now)
