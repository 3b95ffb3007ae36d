import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.links.outbox import CAPACITY, PATIENCE, Outbox
from teleop.ports import LinkError

FRAME = bytes(range(26))


class Port:
    """Takes as many bytes as there is room for, or, as a CAN queue, whole pieces only."""

    def __init__(self, room: int = 0, whole: bool = True) -> None:
        self.taken = bytearray()
        self.room = room
        self.whole = whole
        self.now = 0.0
        self.outbox = Outbox("virtual:demo", self.put, 8, lambda: self.now)

    def put(self, piece: bytes) -> int:
        assert 0 < len(piece) <= 8
        accepted = min(len(piece), self.room)
        if self.whole and accepted < len(piece):
            return 0
        self.taken += piece[:accepted]
        self.room -= accepted
        return accepted


@given(
    st.booleans(),
    st.lists(st.tuples(st.binary(min_size=1, max_size=100), st.integers(0, 120)), min_size=1, max_size=60),
)
def test_whatever_the_port_takes_when_whole_frames_leave_in_order(whole: bool, steps: list[tuple[bytes, int]]) -> None:
    port = Port(whole=whole)
    accepted = []
    for frame, room in steps:
        port.room = room
        dropped = port.outbox.counts["dropped"]
        port.outbox.send(frame)
        if port.outbox.counts["dropped"] == dropped:
            accepted.append(frame)
    everything = b"".join(accepted)
    assert everything.startswith(port.taken)
    port.room = len(everything)
    port.outbox.flush()
    assert port.taken == everything


def test_a_full_port_is_offered_the_rest_later() -> None:
    port = Port(room=8)
    port.outbox.send(FRAME)
    assert port.taken == FRAME[:8]
    port.room = 100
    port.now = PATIENCE / 2
    port.outbox.flush()
    assert port.taken == FRAME
    assert port.outbox.counts["full"] == 1


def test_what_has_no_room_is_dropped_whole_and_counted() -> None:
    port = Port()
    held = CAPACITY // len(FRAME)
    for _ in range(held + 3):
        port.outbox.send(FRAME)
    port.room = 1 << 20
    port.outbox.flush()
    assert port.taken == FRAME * held
    assert port.outbox.counts["dropped"] == 3


def test_the_longest_frame_fits() -> None:
    port = Port()
    port.outbox.send(bytes(1023))
    port.room = 2000
    port.outbox.flush()
    assert len(port.taken) == 1023


def test_a_port_that_takes_nothing_for_250_ms_is_lost() -> None:
    port = Port(room=8)
    port.outbox.send(FRAME)
    port.now = PATIENCE - 0.001
    port.outbox.send(FRAME)
    port.now = PATIENCE
    with pytest.raises(LinkError, match="virtual:demo: nothing has left for 250 ms"):
        port.outbox.flush()
    port.outbox.abandon()
    assert (port.outbox.counts["cut"], port.outbox.counts["dropped"]) == (1, 1)


def test_a_single_piece_that_leaves_renews_the_patience() -> None:
    port = Port()
    port.outbox.send(FRAME)
    for _ in range(3):
        port.now += PATIENCE - 0.001
        port.room = 8
        port.outbox.flush()
    assert port.taken == FRAME[:24]


def test_what_a_port_raises_leaves_the_rest_in_place() -> None:
    port = Port(room=8)
    port.outbox.send(FRAME)
    put, port.outbox._put = port.outbox._put, _unplugged
    with pytest.raises(OSError, match="unplugged"):
        port.outbox.flush()
    port.outbox._put, port.room = put, 100
    port.outbox.flush()
    assert port.taken == FRAME


def _unplugged(piece: bytes) -> int:
    raise OSError(f"unplugged before {len(piece)} bytes")
