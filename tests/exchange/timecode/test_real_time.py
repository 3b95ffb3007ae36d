"""A move that chases LTC in real time: libltc's sound through a pipe, the real gateway, the real door."""

from __future__ import annotations

import os
import statistics
import threading
import time
from pathlib import Path

import pytest
from ltc_sound import encoded, is_installed
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


class Tape:
    """Runs from `LEAD` s before the hour, into the pipe, as fast as sound does."""

    def __init__(self, pipe: Path) -> None:
        self._sound = encoded((0, 59, 54, 0), int(FPS * (LEAD + SECONDS)), FPS)
        self._file = os.open(pipe, os.O_RDWR)
        self.began = 0.0
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        self.began = time.monotonic()
        self._thread.start()

    def _run(self) -> None:
        for first in range(0, len(self._sound) // 2, BLOCK):
            end = first + BLOCK  # a block is there once its last sample is
            time.sleep(max(0.0, self.began + end / SAMPLES - time.monotonic()))
            lost = LOST[0] <= end / SAMPLES - LEAD < LOST[1]
            os.write(self._file, bytes(2 * BLOCK) if lost else self._sound[2 * first : 2 * end])

    def place(self, now: float) -> float:
        return now - self.began - LEAD

    def close(self) -> None:
        self._thread.join()
        os.close(self._file)


@pytest.mark.skipif(not is_installed(), reason="libltc is not installed")
def test_it_joins_again_is_within_half_a_frame_in_real_time_and_rests_when_the_sound_ends(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "ltc")
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    entry = f"{{type: timecode, source: ltc, device: 'pipe:{tmp_path}/ltc', rate: 25, chase: nudge, at: '01:00:00:00'}}"
    off: list[float] = []
    tape = Tape(tmp_path / "ltc")
    with opened(checked_profile(f"{text}\nexchange:\n  - {entry}\n", "rig.yaml")) as exchange:
        gateway = Gateway(exchange.settings, exchange.passed)
        with realtime(True, print), remote_bench(tmp_path, clock=SystemClock(), gateway=gateway) as bench:
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
            tape.close()
    assert len(off) > 100
    assert statistics.median(off) < 0.5
