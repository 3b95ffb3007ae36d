import time
import uuid

import can
import pytest
from link_suite import CanSuite, UnpluggedSuite
from network import own_network
from pty_lines import SlcanBus

from teleop.links import open_link


def open_ends(near: str, far: str):
    host = open_link(near, now=time.monotonic)
    device = open_link(far, host=False, now=time.monotonic)
    yield host, device
    host.close()
    device.close()


def third_node(url: str):
    interface, _, channel = url.partition(":")
    with can.Bus(channel, interface=interface, ignore_config=True) as bus:

        def inject(arbitration_id: int, data: bytes, *, extended: bool = False) -> None:
            bus.send(can.Message(arbitration_id=arbitration_id, is_extended_id=extended, data=data))

        yield inject


class TestVirtual(CanSuite):
    @pytest.fixture
    def url(self) -> str:
        return f"virtual:{uuid.uuid4()}"

    @pytest.fixture
    def ends(self, url: str):
        yield from open_ends(url, url)

    @pytest.fixture
    def inject(self, url: str):
        yield from third_node(url)


class TestUdpMulticast(CanSuite):
    @pytest.fixture
    def url(self):
        with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
            yield "udp_multicast:239.74.163.2"

    @pytest.fixture
    def ends(self, url: str):
        yield from open_ends(url, url)

    @pytest.fixture
    def inject(self, url: str):
        yield from third_node(url)


class TestSlcan(CanSuite, UnpluggedSuite):
    @pytest.fixture
    def adapters(self):
        adapters = SlcanBus()
        yield adapters
        adapters.close()

    @pytest.fixture
    def ends(self, adapters: SlcanBus):
        yield from open_ends(*(f"slcan:{port}" for port in adapters.ports))

    @pytest.fixture
    def unplug(self, adapters: SlcanBus):
        return adapters.close

    @pytest.fixture
    def inject(self, adapters: SlcanBus):
        def inject(arbitration_id: int, data: bytes, *, extended: bool = False) -> None:
            start = f"T{arbitration_id:08X}" if extended else f"t{arbitration_id:03X}"
            adapters.write(0, f"{start}{len(data)}{data.hex().upper()}\r".encode())

        return inject


class TestSocketcan(CanSuite):
    @pytest.fixture
    def url(self):
        with own_network("link add dev vcan0 type vcan", "link set vcan0 up"):
            yield "socketcan:vcan0"

    @pytest.fixture
    def ends(self, url: str):
        yield from open_ends(url, url)

    @pytest.fixture
    def inject(self, url: str):
        yield from third_node(url)
