"""Listening on a bus: both directions in their order, other ids counted, errors as of a link."""

import errno
import time
import uuid

import can
import pytest
from faulty_bus import FaultyBus, driver_fault, register
from network import own_network
from pty_lines import SlcanBus
from waiting import wait_until

from teleop.core.errors import LinkError
from teleop.links import LinkAddress, Listener, open_link, open_listener
from teleop.links.can import GIMBAL_ID, HOST_ID, CanListener


@pytest.fixture(params=["virtual", "udp_multicast", "socketcan"])
def url(request: pytest.FixtureRequest):
    match request.param:
        case "virtual":
            yield f"virtual:{uuid.uuid4()}"
        case "udp_multicast":
            with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
                yield "udp_multicast:239.74.163.2"
        case "socketcan":
            with own_network("link add dev vcan0 type vcan", "link set vcan0 up"):
                yield "socketcan:vcan0"


def heard(listener: Listener, count: int) -> list[tuple[int, bytes]]:
    """The next `count` CAN frames, or more if more have come."""
    arrived: list[tuple[int, bytes]] = []

    def enough() -> bool:
        arrived.extend(listener.receive())
        return len(arrived) >= count

    wait_until(enough, f"{count} CAN frames")
    return arrived


def test_both_directions_are_heard_in_their_order(url: str) -> None:
    listener = open_listener(url, now=time.monotonic)
    host, device = open_link(url, now=time.monotonic), open_link(url, host=False, now=time.monotonic)
    interface, _, channel = url.partition(":")
    with can.Bus(channel, interface=interface, ignore_config=True) as stranger:
        stranger.send(can.Message(arbitration_id=0x530, is_extended_id=False, data=b"duml"))
        stranger.send(can.Message(arbitration_id=GIMBAL_ID, is_extended_id=True, data=b"extended"))
    host.send(b"from the host")
    assert heard(listener, 2) == [(HOST_ID, b"from the"), (HOST_ID, b" host")]
    device.send(b"answer")
    assert heard(listener, 1) == [(GIMBAL_ID, b"answer")]
    assert listener.foreign == {0x530: 1, GIMBAL_ID: 1}
    assert listener.receive() == []
    for end in (listener, host, device):
        end.close()


def test_an_slcan_adapter_listens_too() -> None:
    adapters = SlcanBus()
    listener = open_listener(f"slcan:{adapters.ports[0]}", now=time.monotonic)
    host = open_link(f"slcan:{adapters.ports[1]}", now=time.monotonic)
    host.send(b"from the host")
    assert heard(listener, 2) == [(HOST_ID, b"from the"), (HOST_ID, b" host")]
    listener.close()
    host.close()
    wait_until(lambda: adapters.commands.count(b"C") == 4)  # each closes its adapter before and after
    adapters.close()


def test_an_adapter_that_is_gone_says_so_in_the_words_of_a_link(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch)
    listener = CanListener(LinkAddress("can", "faulty", "demo", 1_000_000), now=lambda: 0.0)
    FaultyBus.opened[-1].receive_faults.append(driver_fault("Error receiving", errno.ENODEV))
    with pytest.raises(LinkError, match=r"^faulty:demo: the adapter is gone: plug it in"):
        listener.receive()
    listener.close()


def test_a_bus_that_is_not_there() -> None:
    with pytest.raises(LinkError, match=r"^slcan:/dev/ttyNone: no port /dev/ttyNone"):
        open_listener("slcan:/dev/ttyNone", now=lambda: 0.0)
