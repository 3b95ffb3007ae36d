"""What a receiver gets of a gimbal that moves fast: its true attitude at the instant, from a real gateway process."""

from __future__ import annotations

import json
import time
from itertools import pairwise

import cbor2
import pytest
from priorities import children_in_real_time
from tracking_bench import TrackingBench, tracking_bench

from teleop.exchange.freed.codec import decode
from teleop.exchange.opentrackio.packets import parsed

UNEVEN = "the machine was too uneven to tell"
pytestmark = pytest.mark.flaky(reruns=3, only_rerun=["the computer stalled", UNEVEN])

RATE, LATENCY = 50, 0.15


def swing(bench: TrackingBench) -> None:
    assert "ok" in bench.ask("take_control")
    assert "ok" in bench.ask("goto", axes={"pan": 70.0, "tilt": 30.0})


def assert_on_the_way(bench: TrackingBench, rows: list[tuple[float, float, float]]) -> None:
    """Each instant with its pan and tilt; where the machine was uneven, nothing can be said."""
    even = [bench.missed(at, pan, tilt) for at, pan, tilt in rows if bench.kept_up(at)]
    assert len(even) > len(rows) / 4, UNEVEN
    assert max(even) <= 0


def test_freed_messages_have_the_true_attitude_of_their_instant_at_a_rate_without_drift(tmp_path):
    entry = "{type: freed, to: TO, latency: 0.15, camera: 7, position: [1, -2, 1.6], lens: {zoom: 99}}"
    with tracking_bench(tmp_path, entry) as bench:
        bench.receive(0.2)
        children_in_real_time()
        swing(bench)
        rows = bench.receive(2.0)
        # the slots are evenly apart, and the quickest message has arrived next to at once
        numbers = [round((at - rows[0][0]) * RATE) for at, _ in rows]
        begin = min(at - number / RATE for (at, _), number in zip(rows, numbers, strict=True))
        messages = [decode(data).message for _, data in rows]
        instants = [begin + number / RATE - LATENCY for number in numbers]
        assert_on_the_way(bench, [(at, each.pan, each.tilt) for at, each in zip(instants, messages, strict=True)])
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
