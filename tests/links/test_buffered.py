"""What links over real ports have in common: the error that ended a link stays, a full port is no end."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.core.errors import LinkError
from teleop.links.buffered import BufferedLink
from teleop.links.outbox import StalledError
from teleop.links.url import LinkAddress

FRAME = bytes(range(20))


class Port(BufferedLink):
    """Takes pieces of 8 bytes while it has `room`; `fault` is raised by whatever is asked of it."""

    def __init__(self) -> None:
        self.now = 0.0
        self.room = 1000
        self.sent = b""
        self.shut = 0
        self.fault: Exception | None = None
        super().__init__(LinkAddress("serial", "serial", "/dev/ttyX", 115200), 8, lambda: self.now)

    def _put(self, piece: bytes) -> int:
        self._fail()
        taken = piece[: self.room]
        self.room -= len(taken)
        self.sent += taken
        return len(taken)

    def _take(self) -> bytes:
        self._fail()
        return b"arrived"

    def _shut(self) -> None:
        self.shut += 1
        self._fail()

    def _fail(self) -> None:
        if self.fault:
            raise self.fault


def test_receiving_offers_again_what_did_not_fit() -> None:
    port = Port()
    port.room = 8
    port.send(FRAME)
    assert port.sent == FRAME[:8]
    port.room = 1000
    assert port.receive() == b"arrived"
    assert port.sent == FRAME


@pytest.mark.parametrize("call", [lambda port: port.send(FRAME), lambda port: port.receive()], ids=["send", "receive"])
def test_the_error_that_ended_it_is_raised_ever_after(call: Any) -> None:
    port = Port()
    port.fault = OSError(5, "Input/output error")
    with pytest.raises(LinkError, match="serial:/dev/ttyX@115200") as first:
        call(port)
    port.fault = None  # the library below reads as silence from now on
    for again in (lambda: port.send(FRAME), port.receive):
        with pytest.raises(LinkError) as later:
            again()
        assert str(later.value) == str(first.value)
    assert port.sent == b""


def test_an_error_that_is_no_failure_of_the_port_is_a_defect_and_ends_nothing() -> None:
    port = Port()
    port.fault = ZeroDivisionError()
    with pytest.raises(ZeroDivisionError):
        port.receive()
    port.fault = None
    assert port.receive() == b"arrived"


def test_a_port_that_was_full_for_250_ms_may_come_back_and_what_waited_is_given_up() -> None:
    port = Port()
    port.room = 8
    port.send(FRAME)
    port.now = 0.26
    with pytest.raises(StalledError):
        port.receive()
    port.room = 1000
    port.send(b"new")
    assert port.sent == FRAME[:8] + b"new"


def test_closing_offers_what_waits_once_more_and_then_every_call_says_closed() -> None:
    port = Port()
    port.room = 8
    port.send(FRAME)
    port.room = 1000
    port.close()
    assert (port.sent, port.shut) == (FRAME, 1)
    for call in (lambda: port.send(FRAME), port.receive):
        with pytest.raises(LinkError, match="serial:/dev/ttyX@115200: closed"):
            call()
    assert port.sent == FRAME


def test_a_port_that_is_gone_can_be_closed() -> None:
    port = Port()
    port.fault = OSError(19, "No such device")
    port.close()
    assert port.shut == 1
