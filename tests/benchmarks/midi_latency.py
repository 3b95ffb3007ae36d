"""From a MIDI message to its command at the door, and what a controller and timecode cost: processor time.

`python tests/benchmarks/midi_latency.py`; all beside a rig on a virtual clock in one process, as shares of one core.
"""

from __future__ import annotations

import asyncio
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from ltc_sound import encoded, is_installed
from midi_sender import running
from remote_bench import remote_bench
from served_bench import beside_a_rig

from teleop.config.exchange.midi import MidiSection
from teleop.exchange.midi import server
from teleop.exchange.served import Served
from teleop.exchange.timecode.ltc import LtcDecoder
from teleop.exchange.timecode.mtc import MtcDecoder

SECTION = {"type": "midi", "port": "desk", "controls": [{"sends": "cc 60", "jog": "tilt", "step": 0.01}]}
PRESSES = 100


class Desk:
    """A port that passes on what `hear` is given."""

    has_feedback, is_there = True, True

    def open(self, hear: Callable[[Sequence[int]], object]) -> Desk:
        self.hear = hear
        return self

    def send(self, data: Sequence[int]) -> None: ...

    def close(self) -> None: ...


def latency() -> str:
    """A click to the answer of the rig's own tick, which comes every 10 ms here as there."""
    desk, took = Desk(), []

    async def serve(served: Served) -> None:
        await server.serve_port(MidiSection.model_validate(SECTION), served, desk.open)

    async def work(bench: Any, _served: Served) -> None:
        taken = bench.hands.desk.counts.kinds
        while not hasattr(desk, "hear"):
            await asyncio.sleep(0.01)
        for _ in range(PRESSES):
            before, began = taken["jog"], time.perf_counter()
            desk.hear([0xB0, 60, 1])
            while taken["jog"] == before:
                await asyncio.sleep(0.0005)
            took.append((time.perf_counter() - began) * 1000)
            await asyncio.sleep(0.03)

    with tempfile.TemporaryDirectory() as folder:
        beside_a_rig(Path(folder), serve, work, 0.01)
    took.sort()
    return f"p50 {took[len(took) // 2]:.1f} ms, p99 {took[int(0.99 * len(took))]:.1f} ms, of which a tick is up to 10"


def cost_of_a_tick() -> str:
    """What the control process spends on the tick beside the state: a ratio in one run."""
    with tempfile.TemporaryDirectory() as folder, remote_bench(Path(folder)) as bench:
        bench.tick(20)
        publisher = bench.hands._publisher
        best = {}
        for _ in range(10):
            for tick in (None, publisher._tick):
                began = time.process_time()
                for _ in range(500):
                    publisher.publish("running", bench.now, tick)
                spent = (time.process_time() - began) / 500
                best[tick is None] = min(best.get(tick is None, 1.0), spent)
    return f"{best[True] * 1e6:.1f} us without, {best[False] * 1e6:.1f} us with, ratio {best[False] / best[True]:.2f}"


def sound() -> str:
    if not is_installed():
        return "libltc is not installed"
    block, decoder = encoded((1, 0, 0, 0), 250, 25.0), LtcDecoder(48000, 25.0)
    began = time.process_time()
    for first in range(0, len(block), 960):
        decoder.take(block[first : first + 960])
    spent = time.process_time() - began
    decoder.close()
    return f"{100 * spent / 10:.2f} % of a core"


def quarter_frames() -> str:
    """Of MIDI timecode at 25 frames a second: 100 messages a second."""
    messages = [(at, message.bytes()) for at, message in running(90000, 250, 1, 0.0)]
    decoder, readings = MtcDecoder(), 0
    began = time.process_time()
    for at, message in messages:
        readings += decoder.take(message, at) is not None
    spent = time.process_time() - began
    return f"{100 * spent / 10:.3f} % of a core, a reading every {10 / readings * 1000:.0f} ms"


def main() -> None:
    print("MIDI message to door:", latency())
    print("LTC at 48 kHz:", sound())
    print("MIDI timecode:", quarter_frames())
    print("control process, the tick beside its state:", cost_of_a_tick())


if __name__ == "__main__":
    main()
