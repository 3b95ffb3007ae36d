"""Figures of FreeD and OpenTrackIO: `python tests/benchmarks/tracking.py [COUNT] [SECONDS]` prints them.

COUNT (1e5) hostile datagrams, once beside a rig that nobody moves, once beside one that follows them. What a message
costs. In real time, in turns without and with streams: how late the control loop is and how much processor time its
thread takes, and what the gateway takes for each stream. How evenly messages arrive, and how old what they say is.
"""

from __future__ import annotations

import os
import socket
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from itertools import pairwise
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from processor_time import processor_time
from remote_bench import PROFILE, remote_bench
from tracking_fuzz import fuzzed

from teleop.config.profile import checked_profile
from teleop.core.clock import SystemClock
from teleop.core.events import Tick
from teleop.exchange.freed.codec import D1, decode, encode
from teleop.exchange.opening import opened
from teleop.exchange.opentrackio.packets import CBOR, JSON, packets, parsed
from teleop.exchange.opentrackio.sample import Moment, Pose, Source, encoded, identity, received, sample
from teleop.remote.gateway_child import Gateway

COUNT = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else 8.0
STREAMS = (
    "  - {type: freed, to: 'TO', rate: 100}\n"
    "  - {type: freed, to: 'TO', rate: 100, camera: 2}\n"
    "  - {type: opentrackio, to: 'TO', rate: 100}\n"
    "  - {type: opentrackio, to: 'TO', rate: 100, source: 2, encoding: cbor}\n"
)
QUIET = "  - {type: osc, listen: '127.0.0.1:0'}\n"


def cost(what: Callable[[], object], times: int = 5000) -> float:
    """In us."""
    began = time.perf_counter()
    for _ in range(times):
        what()
    return (time.perf_counter() - began) / times * 1e6


class Watch:
    """How late each tick was, and the processor time of the control thread."""

    def __init__(self) -> None:
        self.late: list[float] = []
        self.times: list[float] = []

    def observe(self, tick: Tick) -> None:
        self.late.append(time.monotonic() - tick.time)
        self.times.append(time.thread_time())


def gateway_time() -> float:
    """Of the gateway, in s so far."""
    tasks = Path(f"/proc/{os.getpid()}/task").iterdir()
    children = [each for task in tasks for each in (task / "children").read_text().split()]
    (own,) = [each for each in children if b"teleop.gateway" in Path(f"/proc/{each}/cmdline").read_bytes()]
    return processor_time(int(own))


def run(entries: str, receives: bool = False) -> tuple[Watch, float, list[tuple[float, bytes]]]:
    """What was seen for SECONDS: the loop, the gateway's share of a processor, and, if it `receives`, what arrived.

    A receiver in this process holds its lock against the loop, which no receiver of a user's does.
    """
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        receiver = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        receiver.bind(("127.0.0.1", 0))
        text = entries.replace("TO", f"127.0.0.1:{receiver.getsockname()[1]}")
        profile = checked_profile(f"{PROFILE}\nexchange:\n{text}", "bench.yaml")
        exchange = stack.enter_context(opened(profile))
        gateway = Gateway(exchange.settings, exchange.passed, [])
        watch = Watch()
        bench = stack.enter_context(remote_bench(folder, SystemClock(), watch, gateway))
        thread = threading.Thread(target=bench.loop.run, daemon=True)
        thread.start()
        time.sleep(3.0)  # until all has begun
        rows: list[tuple[float, bytes]] = []
        receiver.setblocking(False)
        with suppress(BlockingIOError):
            while True:  # what arrived before is not counted
                receiver.recv(4096)
        receiver.settimeout(0.2)
        watch.late.clear()
        watch.times.clear()
        before, began = gateway_time(), time.monotonic()
        while (left := began + SECONDS - time.monotonic()) > 0:
            if not receives:
                time.sleep(left)
                break
            with suppress(TimeoutError):
                data = receiver.recv(4096)
                rows.append((time.monotonic(), data))
        share = (gateway_time() - before) / (time.monotonic() - began)
        bench.loop.interrupt("done")
        thread.join()
        return watch, share, rows


def shown(name: str, watch: Watch, share: float) -> None:
    late = sorted(each * 1000 for each in watch.late)
    spent = (watch.times[-1] - watch.times[0]) / len(watch.times) * 1e6
    print(
        f"{name}: loop late {late[len(late) // 2]:.2f} ms p50, {late[int(len(late) * 0.99)]:.2f} ms p99;"
        f" control thread {spent:.0f} us a tick; gateway {share:.1%} of a processor"
    )


def main() -> None:
    for tracks in (False, True):
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as place:
            aims = fuzzed(Path(place), COUNT, tracks=tracks)
        what = "followed within the limits" if tracks else "nothing moved"
        print(f"{COUNT} hostile datagrams in {time.monotonic() - began:.0f} s: {aims} aimed at, {what}")
    message, pose = D1(1, 10.0, 20.0, 0.0, 1.0, 2.0, 3.0), Pose(1, 2, 3, 10, 20, 0)
    data = encode(message)
    print(f"FreeD: {cost(lambda: encode(message)):.0f} us to make, {cost(lambda: decode(data)):.0f} us to read")
    source, moment = Source(1, identity("a", "b", 1), 50.0, "rig", "1"), Moment(1e9, 1, True)
    for name, encoding in (("JSON", JSON), ("CBOR", CBOR)):
        make = lambda: list(  # noqa: E731
            packets(encoded(sample(source, moment, pose, 0.5, "x", True), encoding), encoding, 1, 1400)  # noqa: B023
        )
        (packet,) = make()
        read = cost(lambda: received(parsed(packet).data, encoding))  # noqa: B023
        print(f"OpenTrackIO {name}: {cost(make):.0f} us to make, {read:.0f} us to read, {len(packet)} bytes")
    for _ in range(3):
        without, share_without, _rows = run(QUIET)
        shown("no stream", without, share_without)
        with_streams, share, _rows = run(STREAMS)
        shown("4 streams of 100 Hz", with_streams, share)
        print(f"  a stream: {(share - share_without) / 4:.2%} of a processor")
    rows = run(STREAMS, receives=True)[2]
    freed = [at for at, data in rows if data[0] == 0xD1 and data[1] == 1]
    gaps = [after - before for before, after in pairwise(freed)]
    rate = len(gaps) / (freed[-1] - freed[0])
    even = f"gaps {statistics.mean(gaps) * 1000:.3f} ms +- {statistics.pstdev(gaps) * 1000:.2f} ms"
    print(f"FreeD at 100 Hz: {rate:.2f} messages/s, {even}; each 80 ms old when its slot is due")


if __name__ == "__main__":
    main()
