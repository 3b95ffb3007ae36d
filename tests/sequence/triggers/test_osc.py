"""A start by OSC, over a real UDP port on this computer: the right message, and nothing else, however it looks."""

import socket
import time
from contextlib import ExitStack
from itertools import pairwise
from threading import Event, RLock

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder
from waiting import wait_until

from teleop.core.errors import DeviceError
from teleop.links.osc_packets import messages
from teleop.sequence.triggers.osc import OscTrigger


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def message(address: str, *arguments) -> bytes:
    builder = OscMessageBuilder(address)
    for argument in arguments:
        builder.add_arg(argument)
    return builder.build().dgram


def bundle(address: str) -> bytes:
    builder = OscBundleBuilder(IMMEDIATELY)
    whole = OscMessageBuilder(address)
    builder.add_content(whole.build())
    return builder.build().dgram


def send(port: int, data: bytes) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(data, ("127.0.0.1", port))


@pytest.mark.parametrize("data", [message("/go"), message("/go", 1), message("/go", 1.0, "x"), bundle("/go")])
def test_its_message_fires_it(data):
    port = free_port()
    trigger = OscTrigger("127.0.0.1", port, "/go")
    with ExitStack() as stack:
        trigger.open(stack)
        trigger.arm(0.0)
        assert trigger.waits_for(0.0) == f"OSC /go on 127.0.0.1:{port}"
        assert not trigger.fired(0.0)
        send(port, data)
        wait_until(lambda: trigger.fired(0.0), "the trigger")
        trigger.arm(1.0)
        assert not trigger.fired(1.0)  # what came before does not count


def test_other_messages_a_button_let_go_and_noise_do_not_and_it_goes_on_listening():
    port = free_port()
    trigger = OscTrigger("127.0.0.1", port, "/go")
    with ExitStack() as stack:
        trigger.open(stack)
        trigger.arm(0.0)
        for data in (
            message("/gone"),
            message("/go", 0),
            message("/go", False),
            b"",
            b"/go",
            b"#bundle\0\0\1",
            b"x" * 9000,
        ):
            send(port, data)
        wait_until(lambda: trigger.ignored >= 4, "noise ignored")
        assert not trigger.fired(0.0)
        send(port, message("/go"))
        wait_until(lambda: trigger.fired(0.0), "the trigger")


@given(st.binary(max_size=200))
def test_no_packet_hurts(data):
    trigger = OscTrigger("127.0.0.1", 1, "/go")
    trigger._hear(data)
    trigger._hear(b"#bundle\0" + data)
    assert not trigger.fired(0.0) or b"/go" in data


def test_a_port_that_is_taken_is_said():
    port = free_port()
    with ExitStack() as stack:
        OscTrigger("127.0.0.1", port, "/go").open(stack)
        with pytest.raises(DeviceError, match=f"cannot listen on 127.0.0.1:{port}: Address already in use"):
            OscTrigger("127.0.0.1", port, "/go").open(stack)
    with ExitStack() as stack:  # and is free again afterwards
        OscTrigger("127.0.0.1", port, "/go").open(stack)


def test_a_packet_that_waits_in_the_socket_when_it_is_armed_does_not_count():
    """The thread is kept from taking it, as a busy computer does."""
    port = free_port()
    trigger = OscTrigger("127.0.0.1", port, "/go")
    trigger._lock = RLock()  # type: ignore[assignment] - which `arm` can take while it is held here
    with ExitStack() as stack:
        trigger.open(stack)
        with trigger._lock:
            for _ in range(5):
                send(port, message("/go"))
            trigger.arm(0.0)
        send(port, message("/gone"))
        send(port, b"")  # no OSC: when it is ignored all before it has been read
        wait_until(lambda: trigger.ignored, "the last packet")
        assert not trigger.fired(0.0)
        send(port, message("/go"))
        wait_until(lambda: trigger.fired(0.0), "the trigger")


def test_a_packet_that_is_still_being_read_when_it_is_armed_does_not_count(monkeypatch):
    port = free_port()
    trigger = OscTrigger("127.0.0.1", port, "/go")
    reading, go_on = Event(), Event()

    def slow(data):
        reading.set()
        assert go_on.wait(5)
        return messages(data)

    monkeypatch.setattr("teleop.sequence.triggers.osc.messages", slow)
    with ExitStack() as stack:
        trigger.open(stack)
        trigger.arm(0.0)
        send(port, message("/go"))
        assert reading.wait(5)
        trigger.arm(1.0)  # for another pass, between taking the packet and understanding it
        go_on.set()
        send(port, b"")
        wait_until(lambda: trigger.ignored, "the last packet")
        assert not trigger.fired(1.0)


def test_nothing_counts_before_it_is_armed_at_all():
    trigger = OscTrigger("127.0.0.1", 1, "/go")
    trigger._hear(message("/go"))
    assert not trigger.fired(0.0)
    trigger.arm(0.0)
    assert not trigger.fired(0.0)


def test_a_socket_that_has_only_errors_is_not_asked_again_and_again(monkeypatch):
    asked = Asked()
    monkeypatch.setattr("teleop.sequence.triggers.osc.POLL_PERIOD", 0.02)
    monkeypatch.setattr("teleop.sequence.triggers.osc.select.select", lambda *_: ([1], [], []))
    monkeypatch.setattr("teleop.sequence.triggers.osc._taken", asked)
    with ExitStack() as stack:
        OscTrigger("127.0.0.1", free_port(), "/go").open(stack)
        wait_until(lambda: len(asked.times) > 5)
    gaps = [after - before for before, after in pairwise(asked.times)]
    assert min(gaps) > 0.01


class Asked:
    """Stands in for a read that only fails."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def __call__(self, _listener: object) -> None:
        self.times.append(time.monotonic())
