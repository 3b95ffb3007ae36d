"""The far end of a serial line that is made for it: whoever comes and goes at the near end."""

from __future__ import annotations

from waiting import wait_until

from teleop.core.clock import SystemClock
from teleop.links import open_link
from teleop.links.pty import PtyLink


def test_bytes_pass_both_ways_and_a_second_visitor_finds_it_as_the_first_did() -> None:
    far, clock = PtyLink(), SystemClock()
    for visit in (b"\xaa\x00\r\n\x04first", b"second\xff"):
        near = open_link(f"serial:{far.path}@230400", now=clock.now)
        near.send(visit)
        got = bytearray()
        wait_until(lambda got=got, visit=visit: got.extend(far.receive()) or bytes(got) == visit, "what was sent")
        far.send(visit)
        back = bytearray()
        wait_until(
            lambda back=back, near=near, visit=visit: back.extend(near.receive()) or bytes(back) == visit, "its answer"
        )
        near.close()
        assert far.receive() == b""
    far.close()
    far.close()


def test_what_nobody_reads_is_dropped_and_counted() -> None:
    far = PtyLink()
    for _ in range(100):
        far.send(bytes(1000))
    assert far.counts["dropped"] > 0
    far.close()
