"""A share of the hunt in tests/benchmarks/hunt_exchange_input.py."""

from __future__ import annotations

from exchange_fuzz import dfmoco_hunt, osc_hunt


def test_no_packet_asks_for_what_is_not_in_it() -> None:
    assert osc_hunt(1000) > 10


def test_no_line_moves_what_it_does_not_ask_for() -> None:
    assert dfmoco_hunt(1000) > 10
