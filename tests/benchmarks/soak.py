"""A long run in real time: `python tests/benchmarks/soak.py --minutes 30`.

A hand that never rests at 100 Hz, the simulated gimbal at the far end. A line a minute: memory, ticks, those skipped
and how many of them by our own doing: a tick for which this process computed for longer than a period. What the machine
did meanwhile, working for others and waking late, is beside it. Exits 1 when a tick was skipped by our own doing, or
memory grew by more than MOST.
"""

from __future__ import annotations

import argparse
import gc
import sys
import tempfile
import tracemalloc
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from live_bench import LEFT, REST, RIGHT, TREMBLING, Hand, bench, percentile, rss

from teleop.core.clock import SystemClock
from teleop.core.events import Tick
from teleop.core.timing import PERIOD

SETTLED = 60.0  # s after which nothing is to grow any more
MOST = 2.0  # MB


def holds(time: float) -> bytes:
    """At rest for a moment, then left and right for ever, trembling as a hand does."""
    if time < 2:
        return REST
    side = RIGHT if time % 6 < 3 else LEFT
    return TREMBLING if int(time * 100) % 2 and side is RIGHT else side


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--trace", action="store_true", help="count Python's own memory too, which slows it down")
    asked = parser.parse_args()
    sys.setswitchinterval(0.0005)
    settled: list[float] = []
    if asked.trace:
        tracemalloc.start()
    with tempfile.TemporaryDirectory() as folder, bench(Path(folder), SystemClock()) as run:
        begin = said = SystemClock().now()
        own = 0

        def look(tick: Tick) -> None:
            nonlocal said, own
            elapsed = tick.time - begin
            if run.watch.ticks == 100:  # what is made when it is first used: nothing moves yet
                run.clock.forget()
            if tick.time - said >= min(60.0, asked.minutes * 15):
                said = tick.time
                clock = run.clock
                own += sum(computed > PERIOD for computed in clock.own)
                work, late = percentile(clock.work, 0.99), percentile(clock.late, 0.99)
                line = f"{elapsed / 60:6.1f} min  {rss():6.1f} MB  {run.watch.ticks} ticks, {run.watch.skipped} skipped"
                line += f" ({own} by our own doing), late {1e3 * late:.2f} ms at p99, work {1e3 * work:.2f} ms at p99,"
                line += f" {1e3 * max(clock.work):.2f} at most and {1e3 * max(clock.own):.2f} of it our own"
                if tracemalloc.is_tracing():
                    line += f"  traced {tracemalloc.get_traced_memory()[0] / 1e6:.3f} MB"
                print(line, flush=True)
                run.watch.sent.clear()
                gc.collect()
                if elapsed >= SETTLED:
                    settled.append(rss())
                clock.forget()
            if elapsed >= asked.minutes * 60:
                run.loop.interrupt("enough")

        run.watch.each_tick = look
        hand = Hand(run.pad, holds)
        hand.start()
        ended = run.loop.run()
        hand.stop()
    grown = settled[-1] - settled[0] if settled else 0.0
    if ended.reasons != ["enough"]:
        print(f"it stopped: {'; '.join(ended.reasons)}")
        return 1
    print(f"{own} ticks skipped by our own doing, {grown:+.2f} MB")
    return 1 if own or grown > MOST else 0


if __name__ == "__main__":
    sys.exit(main())
