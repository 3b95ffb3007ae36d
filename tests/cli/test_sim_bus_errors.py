"""`teleop sim --bus-errors`: a share of what passes ends as error frames, in both directions."""

from __future__ import annotations

import threading

import pytest

from teleop.cli.sim import BusNoise, serve
from teleop.core.clock import VirtualClock
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.dji.gimbal.session import Session
from teleop.links.can import CanLink
from teleop.links.memory import pair
from teleop.sim.gimbal.device import SimulatedGimbal

ASKED = 300


class Bus(CanLink):
    """No bus; counts the error frames that it is to send."""

    def __init__(self) -> None:
        self.errors = 0

    def send_error(self) -> None:
        self.errors += 1


@pytest.mark.parametrize(("share", "least", "most"), [(0.0, ASKED, ASKED), (0.3, 110, 185), (1.0, 0, 0)])
def test_a_share_of_questions_and_replies_is_lost(share: float, least: int, most: int) -> None:
    near, far = pair()
    host, stop, replies = Session(), threading.Event(), 0

    class Clock(VirtualClock):
        def sleep_until(self, time: float) -> None:
            nonlocal replies
            replies += sum(received.request is not None for received in host.receive(near.receive(), self.now()))
            super().sleep_until(time)
            if len(asked) == ASKED:
                stop.set()
            else:
                asked.append(time)
                near.send(host.request(gimbal.Angles(AngleKind.ATTITUDE), time)[0])

    asked: list[float] = []
    serve({"gimbal": far}, {"gimbal": SimulatedGimbal()}, Clock(), stop, bus_errors=share)  # type: ignore[arg-type]
    assert least - 1 <= replies <= most  # the last reply may still be on its way


def test_each_loss_is_an_error_frame_on_a_bus() -> None:
    bus = Bus()
    noise = BusNoise(bus, 0.25)
    passed = [noise.left(b"frame") for _ in range(400)]
    assert set(passed) == {b"frame", b""}
    assert bus.errors == passed.count(b"")
    assert 60 < bus.errors < 140
    assert noise.left(b"") == b""
