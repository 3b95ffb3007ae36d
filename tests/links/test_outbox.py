import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.errors import LinkError
from teleop.links.outbox import BUSY_TIMEOUT, CAPACITY, Outbox, Traffic

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
    port.now = BUSY_TIMEOUT / 2
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
    port.now = BUSY_TIMEOUT - 0.001
    port.outbox.send(FRAME)
    port.now = BUSY_TIMEOUT
    with pytest.raises(LinkError, match="virtual:demo: nothing has left for 250 ms"):
        port.outbox.flush()
    port.outbox.abandon()
    assert (port.outbox.counts["cut"], port.outbox.counts["dropped"]) == (1, 1)


def test_a_single_piece_that_leaves_renews_the_patience() -> None:
    port = Port()
    port.outbox.send(FRAME)
    for _ in range(3):
        port.now += BUSY_TIMEOUT - 0.001
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


A, B, C, D = (bytes([mark]) * 20 for mark in b"abcd")


def held(port: Port) -> bytes:
    """What leaves once the port takes everything."""
    port.taken.clear()
    port.room = 1 << 20
    port.outbox.flush()
    return bytes(port.taken)


def test_of_a_stream_the_latest_waits_in_the_place_of_the_one_before() -> None:
    port = Port()
    assert not port.outbox.send(A, Traffic.STREAM, "position")
    assert not port.outbox.send(B, Traffic.STREAM, "focus")
    assert not port.outbox.send(C, Traffic.QUESTION, "angles")
    assert port.outbox.send(D, Traffic.STREAM, "position")
    assert held(port) == D + B + C
    assert port.outbox.counts["superseded"] == 1


def test_a_frame_of_which_a_part_has_left_is_completed() -> None:
    port = Port(room=8)
    port.outbox.send(A, Traffic.STREAM, "position")
    assert not port.outbox.send(B, Traffic.STREAM, "position")
    assert port.outbox.send(C, Traffic.STREAM, "position")
    assert bytes(port.taken) + held(port) == A + C


def test_no_stream_overtakes_an_order() -> None:
    port = Port()
    port.outbox.send(A, Traffic.STREAM, "sticks")
    port.outbox.send(B)  # an order: give control back
    assert not port.outbox.send(C, Traffic.STREAM, "sticks")
    assert port.outbox.send(D, Traffic.STREAM, "sticks")
    assert held(port) == A + B + D


def test_what_has_no_room_is_a_question_before_it_is_an_order_and_never_a_stream() -> None:
    port = Port()
    port.outbox.send(A, Traffic.STREAM, "position")
    for _ in range(CAPACITY // len(B)):
        port.outbox.send(B, Traffic.QUESTION, "angles")
    port.outbox.send(C)
    port.outbox.send(D, Traffic.STREAM, "focus")
    left = held(port)
    assert left.startswith(A + B)
    assert left.endswith(B + C + D)
    assert len(left) <= CAPACITY
    assert port.outbox.counts["dropped"] >= 2


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["order", "question", "x", "y"]), st.integers(1, 60), st.integers(0, 60), st.booleans()
        ),
        max_size=80,
    )
)
def test_whatever_is_sent_no_frame_is_torn_orders_keep_theirs_and_the_latest_of_a_stream_is_the_last(
    steps: list[tuple[str, int, int, bool]],
) -> None:
    """Each frame is its number's bytes, so what left says which they were, in which order."""
    port, sent = Port(whole=False), []
    for number, (what, length, room, drop) in enumerate(steps):
        port.room = room
        frame = bytes([number]) * length
        traffic = {"order": Traffic.ORDER, "question": Traffic.QUESTION}.get(what, Traffic.STREAM)
        port.outbox.send(frame, traffic, what)
        sent.append((what, frame))
        if drop:
            port.outbox.flush()
    port.room = 1 << 20
    port.outbox.flush()
    whole = {frame for _, frame in sent}
    runs = [bytes([mark]) * len(list(run)) for mark, run in itertools.groupby(port.taken)]
    assert all(run in whole for run in runs)
    gone_orders = [run for run in runs if ("order", run) in sent]
    orders = [frame for what, frame in sent if what == "order"]
    assert gone_orders == sorted(gone_orders, key=orders.index)
    assert len(orders) - len(gone_orders) <= port.outbox.counts["dropped"]
    for kind in ("x", "y"):
        of_kind = [frame for what, frame in sent if what == kind]
        gone = [run for run in runs if run in of_kind]
        assert gone == sorted(gone, key=of_kind.index)
        assert gone[-1:] == of_kind[-1:]
        for order in gone_orders if gone else ():
            if sent.index(("order", order)) < sent.index((kind, gone[-1])):
                assert runs.index(order) < runs.index(gone[-1])


def test_a_port_that_goes_on_taking_less_than_it_is_given_is_behind() -> None:
    port = Port()
    for tick in range(400):
        port.now = tick / 100
        port.room = 8
        port.outbox.send(FRAME, Traffic.STREAM, "position")
    assert port.outbox.behind


@pytest.mark.parametrize("hiccup", [0.0, 0.2])
def test_a_port_that_is_full_for_a_moment_now_and_then_is_not(hiccup: float) -> None:
    port = Port(room=1 << 20)
    for tick in range(2000):
        port.now = tick / 100
        port.room = 0 if port.now % 1.5 < hiccup else 1 << 20
        port.outbox.send(FRAME, Traffic.STREAM, "position")
    assert not port.outbox.behind


def _unplugged(piece: bytes) -> int:
    raise OSError(f"unplugged before {len(piece)} bytes")
