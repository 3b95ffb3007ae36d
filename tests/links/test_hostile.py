"""Frames through hostile adapters: whatever reached the bus undamaged is found, and nothing ever raises."""

import math
import time
from random import Random

import pytest
from hostile import TRICKS, Hostile
from hypothesis import given
from hypothesis import strategies as st
from pty_lines import SlcanBus
from waiting import collect

from teleop.dji.frame import Frame, FrameReader
from teleop.links import ClosableLink, open_link
from teleop.links.memory import pair


def frame(sequence: int) -> Frame:
    return Frame(b"\x0e\x00" + Random(sequence).randbytes(2 + sequence % 30), 0x03, sequence)


def frames_in(stream: bytes) -> list[Frame]:
    reader = FrameReader()
    found = [part for at, byte in enumerate(stream) for part in reader.feed(bytes([byte]), at * 1e-5)]
    return [part for part in (*found, *reader.flush(math.inf)) if isinstance(part, Frame)]


def check_survival(sending: ClosableLink, receiving: ClosableLink, names: list[str], seed: int) -> None:
    hostile = Hostile(sending, Random(seed), *names)
    damaged, good = [frame(number) for number in range(12)], [frame(number) for number in range(100, 103)]
    for each in damaged:
        hostile.send(each.encode())
    for each in good:
        sending.send(each.encode())
    stream = collect(receiving, hostile.sent + sum(len(each.encode()) for each in good))
    found = frames_in(stream)
    assert found[-3:] == good
    assert {each for each in damaged if each.encode() in stream} == set(found[:-3])


@given(st.lists(st.sampled_from(sorted(TRICKS)), max_size=5), st.integers(0, 1 << 32))
def test_a_good_frame_behind_a_damaged_one_survives(names: list[str], seed: int) -> None:
    check_survival(*pair(), names, seed)


def test_the_tricks_do_damage() -> None:
    for name in set(TRICKS) - {"split"}:
        near, far = pair()
        hostile = Hostile(near, Random(1), name)
        for number in range(12):
            hostile.send(frame(number).encode())
        assert frames_in(far.receive()) != [frame(number) for number in range(12)], name


@pytest.fixture
def virtual_ends():
    ends = [open_link("virtual:hostile", host=host, now=time.monotonic) for host in (True, False)]
    yield ends
    for end in ends:
        end.close()


@pytest.fixture
def slcan_ends():
    bus = SlcanBus()
    ends = [open_link(f"slcan:{port}", host=not side, now=time.monotonic) for side, port in enumerate(bus.ports)]
    yield ends
    for end in ends:
        end.close()
    bus.close()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("ends", ["virtual_ends", "slcan_ends"])
def test_the_same_on_real_adapters(ends: str, seed: int, request: pytest.FixtureRequest) -> None:
    near, far = request.getfixturevalue(ends)
    check_survival(near, far, sorted(TRICKS), seed)
    check_survival(far, near, sorted(TRICKS), seed)
