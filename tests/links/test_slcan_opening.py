"""Taking an slcan adapter onto its bus: deaf, mute, refusing and already open ones, in virtual time; one on a pty."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable

import pytest
from pty_lines import SlcanBus
from waiting import collect

from teleop.core.errors import LinkError
from teleop.links import LinkAddress, open_link
from teleop.links.can import Arrival
from teleop.links.slcan import SlcanAdapter
from teleop.links.slcan_opening import ANSWER_TIMEOUT, go_on_bus

ADDRESS = LinkAddress("can", "slcan", "/dev/ttyACM0", 1_000_000)


class Firmware:
    """An adapter on a port in virtual time; `deaf_for` s after its first byte nothing is heard, and that is lost.

    `answers` says what it answers to a command; frames come from its bus each 50 ms while it is open, with `traffic`.
    """

    def __init__(self, deaf_for: float = 0.0, traffic: bool = False, opened: bool = False, end: bytes = b"\r") -> None:
        self.now = 0.0
        self.deaf_for, self.traffic, self.opened, self._end = deaf_for, traffic, opened, end
        self.commands: list[bytes] = []
        self.answers: Callable[[bytes], bytes] = self.lawicel
        self.speed = b""
        self._first: float | None = None
        self._line, self._out, self._late = b"", b"", 0.0
        self._next_frame = 0.0
        self.closed = False

    def lawicel(self, command: bytes) -> bytes:
        if command[:1] == b"C" and self.opened:
            self.opened = False
        elif command[:1] == b"S" and not self.opened:
            self.speed = command
        elif command == b"O" and not self.opened and self.speed:
            self.opened = True
        elif command:
            return b"\a"
        return self._end

    def mute(self, command: bytes) -> bytes:
        self.lawicel(command)
        return b""

    def write(self, data: bytes) -> int:
        if self._first is None:
            self._first = self.now
        if self.now - self._first >= self.deaf_for:
            self._line += data
            while b"\r" in self._line:
                command, _, self._line = self._line.partition(b"\r")
                self.commands.append(command)
                self._out += self.answers(command)
        return len(data)

    def read(self) -> bytes:
        if self.opened and self.traffic and self.now >= self._next_frame:
            self._next_frame = self.now + 0.05
            self._out += b"t5301AA" + self._end
        out, self._out = self._out, b""
        return out

    def close(self) -> None:
        self.closed = True

    def wait(self, seconds: float) -> None:
        self.now += seconds

    def open(self) -> SlcanAdapter:
        adapter = SlcanAdapter(ADDRESS, self, Counter(), lambda: self.now)
        go_on_bus(adapter, ADDRESS, 8, self.wait)
        return adapter


def test_an_adapter_that_answers_is_opened_once_and_soon() -> None:
    firmware = Firmware()
    firmware.open()
    assert firmware.commands == [b"", b"C", b"S8", b"O"]
    assert firmware.opened
    assert firmware.now < 0.2


@pytest.mark.parametrize("deaf_for", [0.05, 0.3, 0.45, 1.8, 2.3])
def test_an_adapter_that_resets_when_it_is_opened_is_opened_once_it_hears(deaf_for: float) -> None:
    firmware = Firmware(deaf_for)
    firmware.open()
    assert firmware.opened
    assert firmware.speed == b"S8"
    assert deaf_for <= firmware.now < ANSWER_TIMEOUT


def test_no_half_of_an_opening_counts() -> None:
    """One that hears again just before O would be on its bus at whatever bit rate it starts with."""
    for deaf_for in [step / 100 for step in range(250)]:
        firmware = Firmware(deaf_for)
        firmware.speed = b"S6"  # as it starts
        firmware.open()
        assert (firmware.speed, firmware.opened) == (b"S8", True), deaf_for


@pytest.mark.parametrize("deaf_for", [0.0, 1.8])
def test_an_adapter_that_acknowledges_nothing_is_open_when_frames_arrive(deaf_for: float) -> None:
    firmware = Firmware(deaf_for, traffic=True)
    firmware.answers = firmware.mute
    adapter = firmware.open()
    assert adapter.take() == [Arrival(0x530, True, b"\xaa")]
    assert firmware.speed == b"S8"


def test_one_that_is_open_already_is_closed_first() -> None:
    firmware = Firmware(traffic=True, opened=True)
    firmware.open()
    assert (firmware.opened, firmware.speed) == (True, b"S8")


@pytest.mark.parametrize("deaf_for", [0.0, 99.0])
def test_silence_for_3_s_is_an_error_of_the_adapter(deaf_for: float) -> None:
    firmware = Firmware(deaf_for)
    firmware.answers = firmware.mute
    with pytest.raises(LinkError, match=r"^slcan:/dev/ttyACM0: the adapter does not answer: ") as error:
        firmware.open()
    assert ANSWER_TIMEOUT <= firmware.now < ANSWER_TIMEOUT + 0.5
    assert "gimbal" not in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("refused", "named"), [(b"S8", r"refuses S8 \(1000000 bit/s\)"), (b"O", r"refuses O \(open\)")]
)
def test_a_refusal_of_the_bit_rate_or_of_opening_is_reported_as_one(refused: bytes, named: str) -> None:
    firmware = Firmware()
    firmware.answers = lambda command: b"\a" if command == refused else firmware.lawicel(command)
    with pytest.raises(LinkError, match=f"^slcan:/dev/ttyACM0: the adapter {named}: "):
        firmware.open()
    assert firmware.now < 2


@pytest.mark.parametrize(
    ("refused", "named"), [(b"S8", r"refuses S8 \(1000000 bit/s\)"), (b"O", r"refuses O \(open\)")]
)
def test_frames_do_not_hide_a_refusal(refused: bytes, named: str) -> None:
    """An adapter at its old bit rate may send frames all the same."""
    firmware = Firmware(traffic=True)
    firmware.speed = b"S6"

    def refuses(command: bytes) -> bytes:
        answer = firmware.lawicel(command)
        return b"\a" if command == refused else answer

    firmware.answers = refuses
    with pytest.raises(LinkError, match=f"^slcan:/dev/ttyACM0: the adapter {named}: plug it in again, or use an"):
        firmware.open()


def test_a_refused_bit_rate_is_forgotten_once_a_later_round_succeeds() -> None:
    firmware, heard = Firmware(traffic=True), []

    def first_refused(command: bytes) -> bytes:
        heard.append(command)
        return b"\a" if command == b"S8" and heard.count(b"S8") < 3 else firmware.lawicel(command)

    firmware.answers = first_refused
    firmware.speed = b"S6"
    firmware.open()
    assert (firmware.opened, firmware.speed) == (True, b"S8")
    assert heard.count(b"S8") == 3


def test_one_that_refuses_what_it_heard_in_half_is_asked_again() -> None:
    firmware, heard = Firmware(), []

    def first_refused(command: bytes) -> bytes:
        heard.append(command)
        return b"\a" if heard.count(b"S8") == 1 else firmware.lawicel(command)

    firmware.answers = first_refused
    firmware.open()
    assert firmware.opened


def test_line_ends_of_cr_lf() -> None:
    firmware = Firmware(traffic=True, end=b"\r\n")
    adapter = firmware.open()
    firmware._out += b"t2222AABB\r\nz\r\n\r"
    firmware.traffic = False
    assert Arrival(0x222, True, b"\xaa\xbb") in adapter.take()
    firmware._out += b"\nt2221CC\r\n"  # a line end in two parts
    assert adapter.take() == [Arrival(0x222, True, b"\xcc")]
    assert not adapter._counts


def test_what_waits_for_an_adapter_ends_with_ctrl_c(monkeypatch: pytest.MonkeyPatch) -> None:
    hardware = SlcanBus()
    hardware.freeze()
    looks = iter(range(20))

    def interrupted(_seconds: float) -> None:
        if next(looks) == 10:
            raise KeyboardInterrupt

    monkeypatch.setattr(time, "sleep", interrupted)
    with pytest.raises(KeyboardInterrupt):
        open_link(f"slcan:{hardware.ports[0]}", now=lambda: 0.0)
    monkeypatch.undo()
    hardware.close()


class Resetting(SlcanBus):
    """Both adapters are deaf for 1.8 s after their first byte, and what was sent is lost."""

    DEAF = 1.8

    def __init__(self) -> None:
        self._first: dict[int, float] = {}
        super().__init__()

    def handle(self, side: int, data: bytes) -> None:
        if time.monotonic() - self._first.setdefault(side, time.monotonic()) >= self.DEAF:
            super().handle(side, data)


class OtherBitRate(SlcanBus):
    """The adapters refuse S8, and send a frame with each command all the same."""

    def handle(self, side: int, data: bytes) -> None:
        for command in data.split(b"\r")[:-1]:
            self.write(side, b"t2221AA\r" + (b"\a" if command.startswith(b"S") else b"\r"))


def test_a_refused_bit_rate_on_a_pty_is_an_error_of_one_line() -> None:
    hardware = OtherBitRate()
    try:
        with pytest.raises(LinkError, match=r"^slcan:/dev/\S+: the adapter refuses S8 \(1000000 bit/s\): ") as error:
            open_link(f"slcan:{hardware.ports[0]}", now=time.monotonic)
        assert "\n" not in str(error.value)
    finally:
        hardware.close()


def test_a_link_over_an_adapter_on_a_pty_that_resets() -> None:
    hardware = Resetting()
    host = open_link(f"slcan:{hardware.ports[0]}", now=time.monotonic)
    gimbal = open_link(f"slcan:{hardware.ports[1]}", host=False, now=time.monotonic)
    host.send(b"whole frame of 24 bytes.")
    assert collect(gimbal, 24) == b"whole frame of 24 bytes."
    host.close()
    gimbal.close()
    hardware.close()
