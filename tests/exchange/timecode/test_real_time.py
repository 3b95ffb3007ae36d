"""A move that chases timecode in real time, by the real gateway and the real door.

LTC is libltc's sound through a pipe; MIDI timecode comes from a client of JACK.
"""

from __future__ import annotations

import os
import statistics
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from jack_server import INSTALLED, JackController, jack_server
from ltc_sound import encoded, is_installed
from midi_sender import quarters
from remote_bench import remote_bench

from teleop.app.realtime import realtime
from teleop.config.profile import checked_profile
from teleop.config.resources import find
from teleop.core.clock import SystemClock
from teleop.exchange.opening import opened
from teleop.remote.gateway_child import Gateway

FPS, BLOCK, SAMPLES = 25.0, 960, 48000
LEAD, SECONDS = 6.0, 5.0
LOST = -4.5, -4.0  # s of the code that nobody hears, while the axes go to the start of the move


class Tape(ABC):
    """Runs from `LEAD` s before the hour to `SECONDS` after it, as fast as time does."""

    entry: str  # of the exchange that hears it

    def __init__(self) -> None:
        self.began = 0.0
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        self.began = time.monotonic()
        self._thread.start()

    @abstractmethod
    def _run(self) -> None: ...

    def place(self, now: float) -> float:
        return now - self.began - LEAD

    def _wait(self, seconds: float) -> bool:
        """Until so many of the tape have gone by; whether it is heard then."""
        time.sleep(max(0.0, self.began + seconds - time.monotonic()))
        return not LOST[0] <= seconds - LEAD < LOST[1]

    def close(self) -> None:
        self._thread.join()


class SoundTape(Tape):
    def __init__(self, folder: Path) -> None:
        super().__init__()
        pipe = folder / "ltc"
        os.mkfifo(pipe)
        self.entry = f"source: ltc, device: 'pipe:{pipe}', rate: 25"
        self._sound = encoded((0, 59, 54, 0), int(FPS * (LEAD + SECONDS)), FPS)
        self._file = os.open(pipe, os.O_RDWR)

    def _run(self) -> None:
        for first in range(0, len(self._sound) // 2, BLOCK):
            end = first + BLOCK  # a block is there once its last sample is
            is_heard = self._wait(end / SAMPLES)
            os.write(self._file, self._sound[2 * first : 2 * end] if is_heard else bytes(2 * BLOCK))

    def close(self) -> None:
        super().close()
        os.close(self._file)


class MidiTape(Tape):
    entry = "source: mtc, port: tape, api: jack"

    def __init__(self) -> None:
        super().__init__()
        self._controller = JackController("tape")

    def _run(self) -> None:
        first = round((3600 - LEAD) * FPS)
        for pair in range(0, int(FPS * (LEAD + SECONDS)), 2):
            for quarter, message in enumerate(quarters(first + pair, 1)):
                if self._wait((pair + quarter / 4) / FPS):
                    self._controller.send(*message.bytes())

    def close(self) -> None:
        super().close()
        self._controller.close()


@contextmanager
def tape_of(source: str, folder: Path) -> Iterator[Tape]:
    with ExitStack() as stack:
        if source == "mtc":
            stack.enter_context(jack_server(period=64))  # 1.3 ms, by which what is sent comes later
        tape = SoundTape(folder) if source == "ltc" else MidiTape()
        stack.callback(tape.close)
        yield tape


@pytest.mark.parametrize(
    "source",
    [
        pytest.param("ltc", marks=pytest.mark.skipif(not is_installed(), reason="libltc is not installed")),
        pytest.param("mtc", marks=pytest.mark.skipif(not INSTALLED, reason="jackd is not installed")),
    ],
)
def test_it_joins_again_is_within_half_a_frame_in_real_time_and_rests_when_the_code_ends(
    source: str, tmp_path: Path
) -> None:
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    off: list[float] = []
    with tape_of(source, tmp_path) as tape:
        entry = f"{{type: timecode, {tape.entry}, chase: nudge, at: '01:00:00:00'}}"
        exchange = checked_profile(f"{text}\nexchange:\n  - {entry}\n", "rig.yaml")
        with opened(exchange) as served, realtime(True, print):
            gateway = Gateway(served.settings, served.passed)
            with remote_bench(tmp_path, clock=SystemClock(), gateway=gateway) as bench:
                bench.quiet = True  # the real gateway says that it is there
                while bench.hands.desk.gateway_at < 0:
                    bench.tick()
                tape.start()
                while tape.place(bench.now) < SECONDS:
                    bench.tick()
                    move = bench.state["move"]
                    if move and move["phase"] == "playing" and tape.place(bench.now) > 2.0:
                        off.append(abs(move["at"] - tape.place(bench.state["time"])) * FPS)
                while not (
                    any("is lost" in line for line in bench.lines[:2])
                    and (bench.state["move"] or {}).get("phase") == "paused"
                    and bench.rests
                ):
                    bench.tick()
    assert len(off) > 100
    assert statistics.median(off) < 0.5
