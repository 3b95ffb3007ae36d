"""Issue 5's figures of the live path: `pytest tests/benchmarks/test_live.py --benchmark-enable -s -n 0` prints them.

Each is measured beside a bare loop, one that only sleeps to the same grid, on the same machine at the same time, so
that the machine drops out. Nothing is asserted about time: without `--benchmark-enable` the same runs are short, and
only what they did is checked. The half hour in real time is `soak.py`'s.
"""

from __future__ import annotations

import random
import subprocess
import sys
import threading
import tracemalloc
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from time import monotonic, sleep

import pytest
from fake_hid import BrokenDevice, FakeDevice
from live_bench import REST, RIGHT, Bench, Hand, bench, percentile, rss
from waiting import wait_until

from teleop.cli.doctor.timing import sleep_late
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.events import Tick
from teleop.core.timing import PERIOD

_BARE = "import sys; from teleop.cli.doctor.timing import sleep_late; print(*sleep_late(int(sys.argv[1])))"


@pytest.fixture
def amount(request: pytest.FixtureRequest) -> Callable[[float, float], float]:
    """So much when figures are asked for, else so little."""
    enabled = request.config.getoption("--benchmark-enable")
    return lambda much, little: much if enabled else little


class Pushes:
    """A hand that pushes the stick again and again, at any moment of a tick, and waits each time for the frame."""

    def __init__(self, run: Bench, times: int) -> None:
        self.latencies: list[float] = []
        self._run, self._times, self._dice = run, times, random.Random(5)

    def __call__(self) -> None:
        try:
            self._report(REST, 80)
            for _ in range(self._times):
                self._report(REST, 60)
                sleep(self._dice.random() * PERIOD)
                sent = self._run.watch.sent
                assert not sent[-1][2], "the gimbal is at rest"
                known = len(sent)
                pushed = monotonic()
                self._run.pad.report(RIGHT)
                self.latencies.append(self._next_that_moves(known) - pushed)
        finally:
            self._run.loop.interrupt("enough")

    def _next_that_moves(self, known: int) -> float:
        sent = self._run.watch.sent
        wait_until(lambda: any(moves for _, _, moves in sent[known:]), "a frame that moves it")
        return next(at for _, at, moves in sent[known:] if moves)

    def _report(self, report: bytes, times: int) -> None:
        for _ in range(times):
            self._run.pad.report(report)
            sleep(PERIOD)


def bare_latencies(times: int) -> list[float]:
    """The same hand, and a loop that only looks whether there is something and says when."""
    pushed: list[float] = []
    seen: list[float] = []
    dice, clock, over = random.Random(5), SystemClock(), threading.Event()

    def look() -> None:
        due = clock.now()
        while not over.is_set():
            due += PERIOD
            clock.sleep_until(due)
            if len(pushed) > len(seen):
                seen.append(monotonic())

    loop = threading.Thread(target=look)
    loop.start()
    for _ in range(times):
        sleep(0.02 + dice.random() * PERIOD)
        pushed.append(monotonic())
        wait_until(lambda: len(seen) == len(pushed))
    over.set()
    loop.join()
    return [at - since for since, at in zip(pushed, seen, strict=True)]


def milliseconds(values: list[float]) -> str:
    return f"{1e3 * percentile(values, 0.5):6.2f} {1e3 * percentile(values, 0.99):6.2f} {1e3 * max(values):6.2f} ms"


def test_stick_to_first_frame(tmp_path: Path, amount: Callable[[float, float], float]) -> None:
    times = round(amount(150, 2))
    sys.setswitchinterval(0.0005)  # as `perform` sets it
    before = bare_latencies(times)
    with bench(tmp_path, SystemClock()) as run:
        pushes = Pushes(run, times)
        hand = threading.Thread(target=pushes)
        hand.start()
        run.loop.run()
        hand.join()
    bare = [*before, *bare_latencies(times)]
    assert len(pushes.latencies) == times
    print(f"\nstick to first frame, p50 p99 max of {times}:  {milliseconds(pushes.latencies)}")
    print(f"a bare loop, before and after:            {milliseconds(bare)}")
    beyond = percentile(pushes.latencies, 0.99) - percentile(bare, 0.99)
    print(f"beyond it at p99: {1e3 * beyond:.2f} ms; at most a period and 1 ms: {1e3 * PERIOD + 1:.0f} ms")


def test_spacing_of_commands(tmp_path: Path, amount: Callable[[float, float], float]) -> None:
    seconds = amount(60, 1)
    ticks = str(round(seconds / PERIOD))
    sys.setswitchinterval(0.0005)
    with bench(tmp_path, SystemClock()) as run:
        hand = Hand(run.pad, lambda time: RIGHT if time > 1 else REST)
        hand.start()
        begin = SystemClock().now() + 1.5

        def look(tick: Tick) -> None:
            if tick.time > begin + seconds:
                run.loop.interrupt("enough")

        run.watch.each_tick = look
        with subprocess.Popen([sys.executable, "-c", _BARE, ticks], stdout=subprocess.PIPE, text=True) as beside:
            run.loop.run()
            bare = [float(each) for each in beside.communicate()[0].split()]
        hand.stop()
    ours = [(due, at - due) for due, at, _ in run.watch.sent if begin <= due < begin + seconds]
    assert len(ours) == pytest.approx(seconds * 50, rel=0.2)
    assert len(bare) == int(ticks)
    theirs = [(number * PERIOD, late) for number, late in enumerate(bare) if number % 2]
    late, bare_late = spacing(ours), spacing(theirs)
    print(f"\ncommands at 50 Hz, apart by more than 20 ms by, p50 p99 max: {milliseconds(late)}")
    print(f"a bare loop beside them:                                     {milliseconds(bare_late)}")
    print(f"ratio at p99: {percentile(late, 0.99) / percentile(bare_late, 0.99):.2f} (at most 1.5)")
    after = percentile([after for _, after in ours], 0.99) / percentile(bare, 0.99)
    print(
        f"after the tick, the tick's work before it included: {milliseconds([after for _, after in ours])}, {after:.2f}"
    )


def test_a_device_that_cannot_be_read_is_not_felt(tmp_path: Path, amount: Callable[[float, float], float]) -> None:
    """How late the loop wakes with such a device and with a sound one, in turn; the machine is in both."""
    seconds, rounds = amount(10, 0.5), int(amount(3, 1))
    late: dict[type[FakeDevice], list[float]] = {FakeDevice: [], BrokenDevice: []}
    opened = 0
    sys.setswitchinterval(0.0005)
    for _ in range(rounds):
        for device, noted in late.items():
            with bench(tmp_path, SystemClock(), device) as run:
                end = SystemClock().now() + 0.5 + seconds

                def look(tick: Tick, run: Bench = run, end: float = end) -> None:
                    if tick.time > end:
                        run.loop.interrupt("enough")

                run.watch.each_tick = look
                run.loop.run()
                noted += run.clock.late
                opened += run.pad.opened * (device is BrokenDevice)
    assert opened <= rounds * (seconds + 3)
    for device, noted in late.items():
        assert len(noted) > seconds * rounds / PERIOD / 4
        print(f"\nloop late by, p50 p99 max, with a {device.__name__}: {milliseconds(noted)}")
    ratio = percentile(late[BrokenDevice], 0.99) / percentile(late[FakeDevice], 0.99)
    print(f"ratio at p99: {ratio:.2f} (about 1); it was opened {opened / rounds / seconds:.2f} times a second")


def spacing(sent: list[tuple[float, float]]) -> list[float]:
    """How much later than it should have after the one before it each was sent; `sent` is when due, and how late."""
    return [max(0.0, late - before) for (_, before), (_, late) in pairwise(sent)]


@pytest.mark.timeout(900)  # 180000 ticks, each of them traced, are minutes of wall time beside other work
def test_memory_stays_flat_and_no_tick_is_skipped(tmp_path: Path, amount: Callable[[float, float], float]) -> None:
    """On virtual time, with a hand that never rests: what grows, grows with the ticks."""
    minutes = amount(30, 0.5)
    marks: list[tuple[float, float, int]] = []
    with bench(tmp_path, VirtualClock(100.0)) as run:

        def look(tick: Tick) -> None:
            elapsed = tick.time - 100.0
            pushed = elapsed > 1.0
            run.pad.told(bytes([0xFF - run.watch.ticks % 2 if pushed else 0x7F]) + REST[1:])
            if elapsed >= minutes * 60 * (len(marks) + 1) / 10:
                for noted in (run.clock.work, run.clock.own, run.clock.late, run.watch.sent):
                    noted.clear()
                marks.append((elapsed, rss(), tracemalloc.get_traced_memory()[0]))
            if elapsed >= minutes * 60:
                run.loop.interrupt("enough")

        run.watch.each_tick = look
        tracemalloc.start()
        run.loop.run()
        tracemalloc.stop()
    assert run.watch.skipped == 0
    assert run.watch.ticks == pytest.approx(minutes * 6000, rel=0.02)
    first, last = marks[1], marks[-1]
    print(f"\n{run.watch.ticks} ticks in virtual time, {run.watch.skipped} skipped")
    print(f"after {first[0] / 60:.1f} min {first[1]:.1f} MB, {first[2] / 1e3:.0f} kB of Python's own")
    print(f"after {last[0] / 60:.1f} min {last[1]:.1f} MB, {last[2] / 1e3:.0f} kB of Python's own")
    assert last[2] - first[2] < 200e3, "bytes; a tick that was kept would be 100 times that over half an hour"


def test_the_bare_loop_is_the_doctors() -> None:
    assert len(sleep_late(3)) == 3
