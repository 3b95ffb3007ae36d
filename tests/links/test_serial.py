import time

import pytest
from link_suite import LinkSuite, UnpluggedSuite
from pty_lines import NullModem
from waiting import wait_until

from teleop.core.errors import LinkError
from teleop.links import FAR_END, open_link, open_listener, parse
from teleop.links.serial import SerialLink


class TestSerial(LinkSuite, UnpluggedSuite):
    @pytest.fixture
    def cable(self):
        cable = NullModem()
        yield cable
        cable.close()

    @pytest.fixture
    def ends(self, cable: NullModem):
        near, far = (open_link(f"serial:{port}@230400", now=time.monotonic) for port in cable.ports)
        yield near, far
        near.close()
        far.close()

    @pytest.fixture
    def unplug(self, cable: NullModem):
        return cable.close

    def test_a_port_has_one_user(self, ends, cable: NullModem) -> None:
        assert ends
        with pytest.raises(LinkError, match=r"^serial:.*@230400: .* is in use by another program$"):
            open_link(f"serial:{cable.ports[0]}@230400", now=time.monotonic)

    def test_a_line_that_fills_up_loses_nothing_that_was_accepted(self, cable: NullModem) -> None:
        near, far = (SerialLink(parse(f"serial:{port}@230400"), now=lambda: 0.0) for port in cable.ports)
        sent = bytearray()
        while not near.counts["full"]:
            frame = len(sent).to_bytes(4, "little") * 250
            near.send(frame)
            sent += frame
        arrived = bytearray()

        def all_arrived() -> bool:
            near.receive()  # offers the rest again
            arrived.extend(far.receive())
            return len(arrived) >= len(sent)

        wait_until(all_arrived)
        assert arrived == sent
        near.close()
        far.close()

    def test_a_port_that_is_not_there(self) -> None:
        with pytest.raises(LinkError, match=r"^serial:/dev/ttyNone@9600: no port /dev/ttyNone: is the adapter plugged"):
            open_link("serial:/dev/ttyNone@9600", now=time.monotonic)


def test_a_listener_hears_the_far_end_and_says_nothing() -> None:
    cable = NullModem()
    far = open_link(f"serial:{cable.ports[0]}@230400", now=time.monotonic)
    listener = open_listener(f"serial:{cable.ports[1]}@230400", now=time.monotonic)
    heard: list[tuple[int, bytes]] = []
    far.send(b"status")
    wait_until(lambda: heard.extend(listener.receive()) or b"".join(data for _, data in heard) == b"status")
    assert {who for who, _ in heard} == {FAR_END}
    assert listener.receive() == []
    assert far.receive() == b""
    listener.close()
    far.close()
    cable.close()


def test_a_listener_on_a_port_that_is_not_there_says_so() -> None:
    with pytest.raises(LinkError, match="no port /dev/nothing-here"):
        open_listener("serial:/dev/nothing-here@9600", now=time.monotonic)
