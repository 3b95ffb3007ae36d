"""What a receiver gets of a gimbal that moves fast: its true attitude at the instant, from a real gateway process."""

from __future__ import annotations

import cmath
import json
import math
import time
from itertools import pairwise
from statistics import median

import cbor2
import pytest
from priorities import children_in_real_time
from tracking_bench import TrackingBench, tracking_bench

from teleop.exchange.freed.codec import decode
from teleop.exchange.opentrackio.packets import parsed

UNEVEN = "the machine was too uneven to tell"
pytestmark = pytest.mark.flaky(reruns=3, only_rerun=["the computer stalled", UNEVEN])

RATE, LATENCY = 50, 0.15
AT_ONCE = 0.003  # s around the usual time of a message in its slot, to be judged


def swing(bench: TrackingBench) -> None:
    assert "ok" in bench.ask("take_control")
    assert "ok" in bench.ask("goto", axes={"pan": 70.0, "tilt": 30.0})


def assert_on_the_way(bench: TrackingBench, rows: list[tuple[float, float, float]]) -> None:
    """Each instant with its pan and tilt; where the machine was uneven, nothing can be said."""
    even = [bench.missed(at, pan, tilt) for at, pan, tilt in rows if bench.kept_up(at)]
    assert len(even) > len(rows) / 4, UNEVEN
    assert max(even) <= 0


def slots_of(arrivals: list[float]) -> dict[int, float]:
    """When the slot of each message (by its row) was due, for those that came in theirs.

    The slots are evenly apart, and most messages arrive next to at once, which says where the slots begin. One that is
    late by a slot or more comes together with the one of that slot, which is sent after it.
    """
    turn = math.tau * RATE
    begin = cmath.phase(sum(cmath.exp(1j * turn * (at - arrivals[0])) for at in arrivals)) / turn + arrivals[0]
    numbers = [round((at - begin) * RATE) for at in arrivals]
    after = [at - begin - number / RATE for at, number in zip(arrivals, numbers, strict=True)]
    usual = median(after)
    last = {number: row for row, number in enumerate(numbers)}
    on_time = {number: row for number, row in last.items() if abs(after[row] - usual) < AT_ONCE}
    return {row: begin + usual + number / RATE for number, row in on_time.items()}


def test_slots_are_found_where_the_first_message_is_late_and_others_come_together():
    due = [100 + number / RATE for number in range(40)]
    arrivals = [at + 0.0004 for at in due]
    arrivals[0] += 0.011  # by half a slot and more
    arrivals[7] = arrivals[8] - 0.0002  # by a whole one
    arrivals[20] += 0.007
    found = slots_of(arrivals)
    assert set(range(40)) - set(found) == {0, 7, 20}
    assert max(abs(at - due[row]) for row, at in found.items()) < 0.001


def test_freed_messages_have_the_true_attitude_of_their_instant_at_a_rate_without_drift(tmp_path):
    entry = "{type: freed, to: TO, latency: 0.15, camera: 7, position: [1, -2, 1.6], lens: {zoom: 99}}"
    with tracking_bench(tmp_path, entry) as bench:
        bench.receive(0.2)
        children_in_real_time()
        swing(bench)
        rows = bench.receive(2.0)
        messages = [decode(data).message for _, data in rows]
        slots = slots_of([at for at, _ in rows])
        assert len(slots) > len(rows) / 2, UNEVEN
        judged = [(at - LATENCY, messages[row].pan, messages[row].tilt) for row, at in slots.items()]
        assert_on_the_way(bench, judged)
        for message in messages:
            assert (message.camera, message.x, message.y, message.z, message.zoom) == (7, 1.0, -2.0, 1.6, 99)
    assert max(after.pan - before.pan for before, after in pairwise(messages)) * RATE > 50
    assert any("each with the attitude of 150 ms before" in line for line in bench.lines)


@pytest.mark.parametrize("encoding", ["json", "cbor"])
def test_opentrackio_samples_have_the_true_attitude_of_their_timestamp(tmp_path, encoding):
    entry = f"{{type: opentrackio, to: TO, latency: 0.15, source: 3, encoding: {encoding}, position: [1, -2, 1.6]}}"
    with tracking_bench(tmp_path, entry) as bench:
        bench.receive(0.2)
        children_in_real_time()
        swing(bench)
        packets = [parsed(data) for _, data in bench.receive(2.2)]
        wall = time.time() - time.monotonic()
        samples = [json.loads(each.data) if encoding == "json" else cbor2.loads(each.data) for each in packets]
        found = []
        for made in samples:
            stamp, (transform,) = made["timing"]["sampleTimestamp"], made["transforms"]
            instant = stamp["seconds"] + stamp["nanoseconds"] / 1e9 - wall
            found.append((instant, -transform["rotation"]["pan"], transform["rotation"]["tilt"]))
            assert transform["translation"] == {"x": 1.0, "y": -2.0, "z": 1.6}
        assert_on_the_way(bench, found)
    assert 1 <= sum("static" in made for made in samples) <= 2
    assert all(after.sequence == before.sequence + 1 for before, after in pairwise(packets))
    assert len({made["sourceId"] for made in samples}) == 1
