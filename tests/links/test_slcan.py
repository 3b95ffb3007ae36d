from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pty_lines import SlcanBus
from waiting import wait_until

from teleop.core.errors import LinkError
from teleop.links import LinkAddress, open_link
from teleop.links.can import Arrival, CanLink
from teleop.links.slcan import SlcanAdapter, open_slcan

FRAME = bytes(range(26))


class Pipe:
    """A port with `arriving` bytes to read and room for `room` to be written."""

    def __init__(self, arriving: bytes = b"", room: int = 1000) -> None:
        self.arriving, self.room = arriving, room
        self.taken = b""
        self.now = 0.0

    def write(self, data: bytes) -> int:
        self.taken += data[: self.room]
        return min(self.room, len(data))

    def read(self) -> bytes:
        arrived, self.arriving = self.arriving, b""
        return arrived

    def close(self) -> None: ...

    def adapter(self) -> SlcanAdapter:
        address = LinkAddress("can", "slcan", "pipe", 1_000_000)
        return SlcanAdapter(address, self, Counter(), lambda: self.now)


class Bench:
    """One slcan adapter and its firmware's side of the serial line."""

    def __init__(self, bitrate: int = 1_000_000) -> None:
        self.now = 0.0
        self.hardware = SlcanBus()
        self.counts: Counter[str] = Counter()
        address = LinkAddress("can", "slcan", self.hardware.ports[0], bitrate)
        self.adapter = open_slcan(address, self.counts, lambda: self.now)
        wait_until(lambda: b"O" in self.hardware.commands)
        self.take_until(b"t7FF0\r")  # the answers to opening

    def take_until(self, line: bytes) -> list[Arrival]:
        """What arrives before the frame that `line`, which the firmware sends now, stands for."""
        self.hardware.write(0, line)
        arrived: list[Arrival] = []

        def is_last() -> bool:
            arrived.extend(self.adapter.take())
            return bool(arrived) and arrived[-1] == Arrival(0x7FF, True, b"")

        wait_until(is_last)
        return arrived[:-1]


@pytest.fixture
def bench():
    bench = Bench()
    yield bench
    bench.adapter.close()
    bench.hardware.close()


@pytest.mark.parametrize(("bitrate", "command"), [(1_000_000, b"S8"), (500_000, b"S6"), (10_000, b"S0")])
def test_opening_sets_the_bit_rate(bitrate: int, command: bytes) -> None:
    bench = Bench(bitrate)
    assert bench.hardware.commands == [b"", b"C", command, b"O"]
    bench.adapter.close()
    wait_until(lambda: bench.hardware.commands[-1] == b"C")
    bench.hardware.close()


@pytest.mark.parametrize("url", ["slcan:/dev/ttyACM0@123456", "slcan:/dev/ttyACM0@fast@1000000"])
def test_a_rate_that_cannot_be_set_is_a_link_error(url: str) -> None:
    with pytest.raises(LinkError, match=r"^slcan:/dev/ttyACM0.*: (slcan has|the serial line)"):
        open_link(url, now=lambda: 0.0)


@pytest.mark.parametrize(
    ("line", "arrival"),
    [
        (b"t2228AABBCCDDEEFF0011", Arrival(0x222, True, bytes.fromhex("aabbccddeeff0011"))),
        (b"t2222aabb", Arrival(0x222, True, b"\xaa\xbb")),
        (b"t2222AABB12CD", Arrival(0x222, True, b"\xaa\xbb")),
        (b"T000002221AA", Arrival(0x222, False, b"\xaa")),
        (b"r2228", Arrival(0x222, False, b"")),
        (b"R000002228", Arrival(0x222, False, b"")),
    ],
)
def test_the_kinds_of_frame(bench: Bench, line: bytes, arrival: Arrival) -> None:
    assert bench.take_until(line + b"\rt7FF0\r") == [arrival]
    assert not bench.counts


@pytest.mark.parametrize(
    "line", [b"t222", b"t2", b"t2229", b"\xff\xfe", b"t22282", b"tXYZ0", b"t2228AABB", b"V1013", b"t222" * 30]
)
def test_a_mutilated_line_is_damage_and_costs_itself_alone(bench: Bench, line: bytes) -> None:
    assert bench.take_until(line + b"\rt2221AA\rt7FF0\r") == [Arrival(0x222, True, b"\xaa")]
    assert bench.counts == {"damage": 1}


@given(st.lists(st.binary(max_size=40)))
def test_any_bytes_can_arrive_before_a_good_frame(data: list[bytes]) -> None:
    pipe = Pipe()
    adapter = pipe.adapter()
    for pipe.arriving in data:
        list(adapter.take())
    pipe.arriving = b"\rt2221AA\r"
    assert Arrival(0x222, True, b"\xaa") in list(adapter.take())


def test_a_line_without_an_end_is_given_up(bench: Bench) -> None:
    bench.hardware.write(0, b"t" * 200)
    wait_until(lambda: list(bench.adapter.take()) == [] and bench.counts["damage"])
    assert bench.take_until(b"\rt7FF0\r") == []


def test_a_frame_that_arrives_byte_by_byte_is_whole(bench: Bench) -> None:
    arrived = []
    for byte in b"t2222AABB\r":
        bench.hardware.write(0, bytes([byte]))
        arrived += list(bench.adapter.take())
    assert arrived + bench.take_until(b"t7FF0\r") == [Arrival(0x222, True, b"\xaa\xbb")]


def test_an_adapter_that_only_refuses_for_250_ms_is_an_error_until_it_acknowledges(bench: Bench) -> None:
    bench.take_until(b"\r\at7FF0\r")
    for bench.now in (0.25, 100.0):
        with pytest.raises(LinkError, match="the adapter refuses every frame"):
            bench.take_until(b"\at7FF0\r")
    assert bench.counts["refused"] == 3
    assert bench.take_until(b"z\rt7FF0\r") == [Arrival(0x7FF, True, b"")] * 2  # those that came with the refusals


def test_a_refused_sender_is_told_and_still_offers_each_frame_until_one_is_acknowledged() -> None:
    pipe = Pipe(b"\r\a")
    adapter = pipe.adapter()
    adapter.take()
    pipe.now, pipe.arriving, pipe.taken = 0.3, b"\a", b""
    for call in (adapter.take, lambda: adapter.put(0x223, b"\x01"), lambda: adapter.put(0x223, b"\x02")):
        with pytest.raises(LinkError, match="the adapter refuses every frame"):
            call()
    pipe.arriving = b"z\r"
    assert adapter.put(0x223, b"\x03")
    assert pipe.taken == b"t223101\rt223102\rt223103\r"


def test_refusals_between_acknowledgements_are_counted_alone(bench: Bench) -> None:
    for bench.now in (0.0, 0.2, 0.4, 0.6):
        bench.take_until(b"\az\rt7FF0\r")
    assert bench.counts == {"refused": 4}


def test_a_single_refusal_is_not_a_lost_link_however_long_ago(bench: Bench) -> None:
    bench.take_until(b"\at7FF0\r")
    bench.now = 10.0
    assert bench.take_until(b"t7FF0\r") == []


def test_an_adapter_that_reads_no_more_is_lost_in_250_ms() -> None:
    now = 0.0
    hardware = SlcanBus()
    link = CanLink(LinkAddress("can", "slcan", hardware.ports[0], 1_000_000), now=lambda: now)
    hardware.freeze()
    while not link.counts["full"]:
        link.send(FRAME)
    now = 0.25
    with pytest.raises(LinkError, match="nothing has left for 250 ms"):
        link.send(FRAME)
    link.close()
    hardware.close()


def test_a_line_that_fits_in_part_is_finished_later() -> None:
    pipe = Pipe()
    adapter = pipe.adapter()
    pipe.taken = b""
    pipe.room = 5
    assert adapter.put(0x223, b"\x01\x02")
    pipe.room = 0
    assert not adapter.put(0x223, b"\x03")
    pipe.room = 100
    assert adapter.put(0x223, b"\x03")
    assert pipe.taken == b"t22320102\rt223103\r"
