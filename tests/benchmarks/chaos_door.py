"""Issue 18's figures of the door, in real time: `python tests/benchmarks/chaos_door.py [SECONDS]` prints them.

How late the loop is at the 99th percentile, without a gateway and with one (then also with four watching pages), each
TURNS times and in turns, so that what else the machine does falls on all of them. How long a STOP takes from a client
to the loop. What 1e5 datagrams that are no commands do.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from chaos_bench import chaos_bench
from door_fuzz import fuzzed
from live_bench import WorkingClock, percentile
from remote_bench import remote_bench
from waiting import wait_until

from teleop.app.realtime import realtime
from teleop.app.run import undisturbed
from teleop.core.clock import SystemClock
from teleop.remote.gateway_child import Gateway

TURNS = 6
SETTLE = 2  # s in which all that is started has loaded what it needs
STOPS = 300
FLOOD = 100_000
WATCHERS = 4
WATCH = """
import asyncio, sys, websockets
async def watch(url):
    async with websockets.connect(url, max_size=None) as socket:
        async for _ in socket: pass
async def main(): await asyncio.gather(*(watch(sys.argv[1]) for _ in range(int(sys.argv[2]))))
asyncio.run(main())
"""


def late(seconds: float, watchers: int | None, fifo: bool) -> Sequence[float]:
    """By how much the loop woke late, in s; `watchers` None for no gateway."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        clock = WorkingClock(SystemClock())
        gateway, url = None, ""
        if watchers is not None:
            from teleop.console.settings import ConsoleSettings, listen

            listener, settings = listen(ConsoleSettings(port=0, moves=str(folder), takes=str(folder)))
            stack.enter_context(listener)
            number = listener.fileno()
            console = {"settings": settings.as_json(), "listener": number}
            gateway, url = Gateway({"console": console}, (number,)), f"ws://127.0.0.1:{settings.port}/ws"
        bench = stack.enter_context(remote_bench(folder, clock=clock, gateway=gateway))

        def run() -> None:
            with undisturbed(), realtime(fifo, print):
                bench.loop.run()

        thread = threading.Thread(target=run)
        thread.start()
        if gateway is not None:
            wait_until(lambda: bench.hands.desk.gateway_at > 0, "the gateway")
        if watchers:
            watching = subprocess.Popen([sys.executable, "-c", WATCH, url, str(watchers)], stderr=subprocess.DEVNULL)
            stack.callback(watching.kill)
        time.sleep(SETTLE)
        clock.forget()
        time.sleep(seconds)
        measured = list(clock.late)
        bench.loop.interrupt("measured")
        thread.join()
        return measured


def lateness(seconds: float, fifo: bool) -> None:
    found: dict[int | None, list[float]] = {None: [], 0: [], WATCHERS: []}
    for _ in range(TURNS):
        for watchers, values in found.items():
            values += late(seconds, watchers, fifo)
    if not all(found.values()):
        print("the machine stalled, and with it a loop: nothing measured")
        return
    bare = percentile(found[None], 0.99)
    for watchers, values in found.items():
        what = "no gateway" if watchers is None else f"a gateway and {watchers} pages"
        p99 = percentile(values, 0.99)
        p50 = percentile(values, 0.5)
        print(f"{'FIFO  ' if fifo else ''}{what}: late {1e3 * p50:.3f} ms, p99 {1e3 * p99:.3f} ms, {p99 / bare:.2f} x")


def stops() -> None:
    with tempfile.TemporaryDirectory() as folder, chaos_bench(Path(folder)) as bench:
        watcher = bench.client("stops", STOPS)
        assert watcher.stdout is not None
        times = [float(line) for line in watcher.stdout]
        print(f"STOP of a watcher in the loop: {percentile(times, 0.5):.1f} ms, p99 {percentile(times, 0.99):.1f} ms")


def flood() -> None:
    with tempfile.TemporaryDirectory() as folder, chaos_bench(Path(folder), fifo=True) as bench:
        client = bench.client("flood", FLOOD)
        said = client.stdout
        assert said is not None
        begin = time.monotonic()
        wait_until(lambda: said.readline() == "flooded\n", "the end of the flood")
        counts = bench.door.counts
        print(
            f"{FLOOD} datagrams in {time.monotonic() - begin:.0f} s: {counts.malformed} malformed,"
            f" {counts.faults} faults, loop faults {bench.loop.faults}, overrun {bench.overruns():.3f} s"
        )


def state_cost() -> None:
    """What the door costs a tick of the control thread, in us."""
    with tempfile.TemporaryDirectory() as folder, remote_bench(Path(folder)) as bench:
        hands, tick = bench.hands, bench.hands._publisher._tick
        count = 5000
        begin = time.perf_counter()
        for _ in range(count):
            hands._publisher.publish("running", tick.time, tick)
        each = time.perf_counter() - begin
        begin = time.perf_counter()
        for _ in range(count):
            hands.desk.poll(tick.time)
        polled = time.perf_counter() - begin
        print(f"a tick: state {1e6 * each / count:.0f} us, commands {1e6 * polled / count:.0f} us")


def fuzz() -> None:
    with tempfile.TemporaryDirectory() as folder:
        print(f"{FLOOD} datagrams made at random, {fuzzed(Path(folder), FLOOD)} malformed: no fault, no motion")


if __name__ == "__main__":
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    state_cost()
    stops()
    lateness(seconds, fifo=True)
    lateness(seconds, fifo=False)
    flood()
    fuzz()
