import errno
import re

import can
import pytest
from faulty_bus import FaultyBus, driver_fault, register
from waiting import collect

from teleop.core.errors import LinkError
from teleop.links import LinkAddress, LinkUrlError, open_link, parse
from teleop.links.can import CanLink
from teleop.links.faults import link_failed, opening_failed

FRAME = bytes(range(26))


class Rig:
    def __init__(self) -> None:
        self.now = 0.0
        address = LinkAddress("can", "faulty", "demo", 1_000_000)
        self.link = CanLink(address, now=lambda: self.now)
        self.far = open_link("virtual:demo", host=False, now=lambda: self.now)
        self.bus = FaultyBus.opened[-1]

    def error_frame(self, classes: int) -> None:
        with can.Bus("demo", interface="virtual", ignore_config=True) as bus:
            bus.send(can.Message(arbitration_id=classes, is_error_frame=True, is_extended_id=False))


@pytest.fixture
def rig(monkeypatch: pytest.MonkeyPatch):
    register(monkeypatch)
    rig = Rig()
    yield rig
    rig.link.close()
    rig.far.close()


def test_a_full_queue_is_counted_and_the_frame_completed(rig: Rig) -> None:
    rig.bus.room = 2
    rig.link.send(FRAME)
    assert rig.far.receive() == FRAME[:16]
    rig.bus.room = 2
    rig.link.receive()
    assert rig.far.receive() == FRAME[16:]
    assert rig.link.counts == {"full": 1}


def test_a_queue_full_for_250_ms_is_an_error_while_it_lasts_and_what_was_held_back_is_dropped(rig: Rig) -> None:
    rig.bus.room = 2
    rig.link.send(FRAME)
    rig.link.send(b"held back")
    rig.now = 0.25
    with pytest.raises(LinkError, match=r"^faulty:demo: nothing has left for 250 ms, the bus is full or off$"):
        rig.link.receive()
    for rig.now in (0.26, 100.0):
        with pytest.raises(LinkError, match="nothing has left for 250 ms"):
            rig.link.send(b"too late")
    assert (rig.link.counts["cut"], rig.link.counts["dropped"]) == (1, 3)
    rig.bus.room = 10
    rig.link.send(b"release")
    assert rig.far.receive() == FRAME[:16] + b"release"


def test_a_queue_that_fills_again_gets_its_250_ms_again(rig: Rig) -> None:
    rig.bus.room = 0
    rig.link.send(FRAME)
    rig.now = 0.3
    with pytest.raises(LinkError):
        rig.link.receive()
    rig.bus.room = 1
    rig.link.send(b"through")
    rig.now = 0.4
    rig.link.send(b"held")
    rig.now = 0.64
    assert rig.link.receive() == b""
    rig.bus.room = 1
    assert rig.link.receive() == b""
    assert rig.far.receive() == b"throughheld"


def test_what_arrives_on_a_full_bus_is_received(rig: Rig) -> None:
    rig.bus.room = 0
    rig.link.send(FRAME)
    rig.now = 0.3
    with pytest.raises(LinkError):
        rig.link.receive()
    rig.far.send(b"angles")
    assert rig.link.receive() == b"angles"


def test_a_send_that_times_out_without_a_number_is_a_full_queue(rig: Rig) -> None:
    rig.bus.send_fault = can.CanOperationError("Transmit buffer full")
    rig.link.send(FRAME)
    assert rig.link.counts == {"full": 1}


@pytest.mark.parametrize("call", ["send", "receive"])
def test_an_unplugged_adapter_raises_once_and_is_lost_for_ever(rig: Rig, call: str) -> None:
    rig.bus.receive_faults.append(driver_fault("Error receiving", errno.ENODEV))
    rig.bus.send_fault = driver_fault("Failed to transmit", errno.ENXIO)
    calls = {"send": lambda: rig.link.send(FRAME), "receive": rig.link.receive}
    for again in (call, "receive", "send"):
        with pytest.raises(LinkError, match=r"^faulty:demo: the adapter is gone: plug it in"):
            calls[again]()


def test_an_interrupted_send_leaves_nothing_of_it_to_a_later_link(rig: Rig) -> None:
    rig.bus.room = 1
    rig.link.send(FRAME)
    rig.link.close()
    assert rig.far.receive() == FRAME[:8]
    assert rig.link.counts == {"full": 2, "cut": 1}


def test_closing_sends_what_was_held_back(rig: Rig) -> None:
    rig.bus.room = 1
    rig.link.send(FRAME)
    rig.bus.room = 10
    rig.link.close()
    assert collect(rig.far, 26) == FRAME


def test_a_bus_that_stays_off_for_250_ms_is_an_error_while_it_lasts(rig: Rig) -> None:
    rig.error_frame(0x40)
    assert rig.link.receive() == b""
    rig.now = 0.2
    rig.error_frame(0x40)
    assert rig.link.receive() == b""
    for rig.now in (0.25, 100.0):
        for call in (rig.link.receive, lambda: rig.link.send(FRAME)):
            with pytest.raises(LinkError, match="the bus is off: check wiring"):
                call()
    assert rig.link.counts == {"bus off": 2, "dropped": 2}
    assert rig.far.receive() == b""


@pytest.mark.parametrize("call", ["send", "receive"])
@pytest.mark.parametrize("sign_of_life", ["restarted", "frame"])
def test_either_call_notices_that_a_bus_is_back(rig: Rig, call: str, sign_of_life: str) -> None:
    rig.error_frame(0x40)
    rig.link.receive()
    rig.now = 1.0
    with pytest.raises(LinkError):
        rig.link.receive()
    if sign_of_life == "restarted":
        rig.error_frame(0x100)
    else:
        rig.far.send(b"alive")
    arrived = rig.link.receive() if call == "receive" else b""
    rig.link.send(b"release")
    assert rig.far.receive() == b"release"
    assert arrived + rig.link.receive() == (b"alive" if sign_of_life == "frame" else b"")


@pytest.mark.parametrize("sign_of_life", ["restarted", "frame"])
def test_a_bus_that_comes_back_is_not_lost(rig: Rig, sign_of_life: str) -> None:
    rig.error_frame(0x40)
    rig.link.receive()
    if sign_of_life == "restarted":
        rig.error_frame(0x100)
    else:
        rig.far.send(b"alive")
    rig.link.receive()
    rig.now = 1.0
    assert rig.link.receive() == b""


def test_other_error_frames_are_no_data(rig: Rig) -> None:
    rig.error_frame(0x222 & ~0x40)
    rig.far.send(b"data")
    assert rig.link.receive() == b"data"
    assert not rig.link.foreign


def test_what_is_no_can_frame_is_counted_as_damage(rig: Rig) -> None:
    strange = can.CanOperationError("could not unpack received message")
    strange.__cause__ = TypeError("unexpected key")
    rig.bus.receive_faults.extend([ValueError("invalid literal for int()"), IndexError("string index"), strange])
    rig.far.send(FRAME)
    assert rig.link.receive() == FRAME
    assert rig.link.counts == {"damage": 3}


def test_a_bus_that_only_fails_does_not_hold_the_loop(rig: Rig) -> None:
    rig.bus.receive_faults.extend([ValueError("again")] * 10_000)
    assert rig.link.receive() == b""
    assert rig.bus.receive_faults


@pytest.mark.parametrize(
    ("url", "number", "says"),
    [
        ("socketcan:can0", 19, "no interface can0: sudo ip link set can0 up type can bitrate 1000000"),
        ("socketcan:can1@500000", 19, "no interface can1: sudo ip link set can1 up type can bitrate 500000"),
        ("socketcan:vcan0", 19, "no interface vcan0: sudo ip link add dev vcan0 type vcan; sudo ip link set vcan0 up"),
        ("socketcan:can0", 97, "this kernel has no SocketCAN: sudo modprobe can_raw, or use slcan"),
        ("slcan:/dev/ttyACM0", 2, "no port /dev/ttyACM0: is the adapter plugged in? `teleop devices` lists the ports"),
        ("slcan:/dev/ttyACM0", 13, "not permitted to open /dev/ttyACM0: sudo usermod -a -G dialout $USER, then log in"),
        ("serial:/dev/ttyUSB0@9600", 11, "/dev/ttyUSB0 is in use by another program"),
        ("socketcan:can0", 22, "Invalid argument"),
    ],
)
def test_a_link_that_does_not_open_says_what_to_do(url: str, number: int, says: str) -> None:
    assert str(opening_failed(parse(url), OSError(number, "as the kernel says"))).startswith(f"{url}: {says}")


@pytest.mark.parametrize(
    ("url", "number", "says"),
    [
        ("socketcan:can0", 100, "can0 is down: sudo ip link set can0 up type can bitrate 1000000"),
        ("socketcan:vcan0", 100, "vcan0 is down: sudo ip link set vcan0 up"),
        ("udp_multicast:239.74.163.2", 101, "no route for multicast: sudo ip route add 239.0.0.0/8 dev lo"),
        ("slcan:/dev/ttyACM0", 5, "the adapter is gone: plug it in, then start again"),
    ],
)
def test_a_link_that_fails_later_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch, url: str, number: int, says: str
) -> None:
    monkeypatch.setattr("socket.if_nametoindex", lambda _name: 3)
    assert str(link_failed(parse(url), driver_fault("Failed", number))) == f"{url}: {says}"


def test_an_interface_that_went_down_because_it_was_removed_is_gone() -> None:
    link = parse("socketcan:no_such0")
    says = "the adapter is gone: plug it in, then start again"
    assert str(link_failed(link, driver_fault("Failed", errno.ENETDOWN))) == f"{link}: {says}"


def test_an_error_without_a_number_keeps_its_first_line() -> None:
    address = LinkAddress("can", "pcan", "PCAN_USBBUS1", 1_000_000)
    assert str(link_failed(address, can.CanOperationError("bus heavy\nmore"))) == "pcan:PCAN_USBBUS1: bus heavy"
    assert str(link_failed(address, can.CanOperationError())) == "pcan:PCAN_USBBUS1: CanOperationError"


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("socketcan:can9", "^socketcan:can9: "),
        ("slcan:/dev/ttyNone", "^slcan:/dev/ttyNone: no port /dev/ttyNone"),
        ("gs_usb:0", "^gs_usb:0: "),
        ("pcan:PCAN_USBBUS1", "^pcan:PCAN_USBBUS1: "),
    ],
)
def test_opening_what_is_not_there_is_one_line_and_nothing_else(
    url: str, says: str, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    with pytest.raises(LinkError, match=says) as refused:
        open_link(url, now=lambda: 0.0)
    assert "\n" not in str(refused.value)
    assert capfd.readouterr() == ("", "")
    assert caplog.records == []


@pytest.mark.parametrize(
    ("url", "says"), [("gs_usb:0", "pip install 'rs-teleop[gs-usb]'"), ("kvaser:0", "documentation of kvaser says")]
)
def test_an_interface_without_its_driver_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, url: str, says: str
) -> None:
    def missing(*_arguments: object, **_options: object) -> None:
        raise NameError("name 'canGetNumberOfChannels' is not defined")

    monkeypatch.setattr("can.Bus", missing)
    with pytest.raises(LinkError, match=f"^{re.escape(url)}: its driver is not installed: .*{re.escape(says)}"):
        open_link(url, now=lambda: 0.0)


def test_a_simulated_device_is_not_a_port() -> None:
    with pytest.raises(LinkUrlError, match="sim:"):
        open_link("sim:", now=lambda: 0.0)
