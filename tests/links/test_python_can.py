"""The habits of python-can's adapters that end in the adapter, each with a bus whose faults the test decides."""

from __future__ import annotations

import errno
from collections import Counter
from collections.abc import Iterator

import can
import pytest
from faulty_bus import FaultyBus, driver_fault, register

from teleop.core.errors import LinkError
from teleop.links.can import Arrival
from teleop.links.outbox import StalledError
from teleop.links.python_can import PythonCanAdapter
from teleop.links.url import LinkAddress

BUS_OFF, RESTARTED = 0x40, 0x100  # Linux can/error.h: CAN_ERR_BUSOFF, CAN_ERR_RESTARTED


class Bench:
    def __init__(self) -> None:
        self.now = 0.0
        self.counts: Counter[str] = Counter()
        address = LinkAddress("can", "faulty", "alone", 1_000_000)
        self.adapter = PythonCanAdapter(address, self.counts, lambda: self.now)
        self.bus = FaultyBus.opened[-1]
        self.far = can.Bus("alone", interface="virtual", ignore_config=True)

    def report(self, classes: int) -> None:
        """The controller reports its state."""
        self.bus.own_errors.append(can.Message(arbitration_id=classes, is_error_frame=True, is_extended_id=False))


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    register(monkeypatch)
    bench = Bench()
    yield bench
    bench.adapter.close()
    bench.far.shutdown()


def test_only_data_with_a_standard_id_is_ordinary(bench: Bench) -> None:
    bench.far.send(can.Message(arbitration_id=0x222, data=b"ab", is_extended_id=False))
    bench.far.send(can.Message(arbitration_id=0x222, data=b"cd", is_extended_id=True))
    bench.far.send(can.Message(arbitration_id=0x222, is_remote_frame=True, is_extended_id=False))
    assert bench.adapter.take() == [
        Arrival(0x222, True, b"ab"),
        Arrival(0x222, False, b"cd"),
        Arrival(0x222, False, b""),
    ]
    assert bench.adapter.take() == []


@pytest.mark.parametrize(
    "fault", [driver_fault("full", errno.ENOBUFS), driver_fault("again", errno.EAGAIN), can.CanOperationError("full")]
)
def test_a_full_queue_takes_nothing_and_is_no_error(bench: Bench, fault: Exception) -> None:
    bench.bus.send_fault = fault
    assert bench.adapter.put(0x223, b"x") is False
    bench.bus.send_fault = None
    assert bench.adapter.put(0x223, b"x") is True
    assert [message.data for message in [bench.far.recv(0)] if message] == [b"x"]


def test_an_adapter_that_is_gone_is_an_error(bench: Bench) -> None:
    bench.bus.send_fault = driver_fault("gone", errno.ENODEV)
    with pytest.raises(can.CanError):
        bench.adapter.put(0x223, b"x")


def test_damage_is_counted_and_reading_goes_on(bench: Bench) -> None:
    bench.bus.receive_faults.extend([ValueError("no CAN frame"), IndexError()])
    bench.far.send(can.Message(arbitration_id=0x222, data=b"after", is_extended_id=False))
    assert bench.adapter.take() == [Arrival(0x222, True, b"after")]
    assert bench.counts == {"damage": 2}


def test_a_bus_that_is_off_for_250_ms_is_an_error_until_it_restarts(bench: Bench) -> None:
    bench.report(BUS_OFF)
    assert bench.adapter.take() == []
    bench.now = 0.3
    for call in (bench.adapter.take, lambda: bench.adapter.put(0x223, b"x")):
        with pytest.raises(StalledError, match="faulty:alone: the bus is off"):
            call()
    bench.report(RESTARTED)
    assert bench.adapter.put(0x223, b"x") is True, "a sender looks too"
    assert bench.counts == {"bus off": 1}


def test_a_frame_of_another_proves_that_the_bus_is_back(bench: Bench) -> None:
    bench.report(BUS_OFF)
    bench.adapter.take()
    bench.now = 0.2
    bench.far.send(can.Message(arbitration_id=0x222, data=b"x", is_extended_id=False))
    bench.adapter.take()
    bench.now = 0.4
    assert bench.adapter.take() == []


def test_what_cannot_be_opened_is_a_link_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_args: object, **_options: object) -> None:
        raise can.CanInitializationError("no such thing")

    monkeypatch.setattr(can, "Bus", refuse)
    with pytest.raises(LinkError, match="faulty:alone"):
        PythonCanAdapter(LinkAddress("can", "faulty", "alone", 1_000_000), Counter(), lambda: 0.0)
