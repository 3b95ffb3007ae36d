"""How long other threads of a process, and the starts of its children, hold up its control thread on a busy computer.

`python tests/benchmarks/realtime_stalls.py [BUSY]` prints by how much a thread at 1 kHz on SCHED_FIFO woke late, beside
BUSY busy processes, while another thread of the process works in Python, makes long calls, and starts children: as an
ordinary thread, and as `--realtime` has it.
"""

from __future__ import annotations

import gc
import os
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack

from teleop.app.realtime import PRIORITY, realtime
from teleop.app.switch_interval import short_switch_interval

SECONDS = 10.0
PERIOD = 0.001
SPINS = "while True: pass"
ALLOCATES = "while True:\n b = bytearray(60 << 20)\n b[::4096] = b'x' * len(b[::4096])"
HEAP = 300  # MB of this process, as a large program has
BLOB = pickle.dumps([[float(number)] * 10 for number in range(20000)])


def nothing() -> None: ...


def python() -> None:
    sum(number * number for number in range(60_000))


def one_long_call() -> None:
    pickle.loads(BLOB)


def child() -> None:
    with subprocess.Popen(
        [sys.executable, "-S", "-c", "pass"], stdin=subprocess.PIPE, start_new_session=True, pass_fds=(0,)
    ) as process:
        process.wait()


def lateness(work: Callable[[], object], with_others: bool) -> list[float]:
    """Of the control thread, in s, in rising order, while another thread does `work` again and again."""
    late: list[float] = []
    over = threading.Event()

    def others() -> None:
        while not over.is_set():
            work()
            time.sleep(0.02)

    def turn() -> None:
        due, end = time.monotonic(), time.monotonic() + SECONDS
        while due < end:
            due = max(due + PERIOD, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))
            late.append(time.monotonic() - due)

    def fifo() -> None:
        if with_others:
            with realtime(True, print):
                turn()
        else:
            os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(PRIORITY))
            turn()

    threads = [threading.Thread(target=each) for each in (others, fifo)]
    with short_switch_interval:
        for thread in threads:
            thread.start()
        threads[1].join()
        over.set()
        threads[0].join()
    return sorted(late)


def main(busy: int) -> None:
    with ExitStack() as stack:
        for number in range(busy):
            process = subprocess.Popen([sys.executable, "-c", SPINS if number % 5 else ALLOCATES])
            stack.callback(process.kill)
        heap = [bytearray(b"x" * (1 << 20)) for _ in range(HEAP)]
        gc.collect()
        gc.freeze()
        print(f"{busy} busy processes, a heap of {len(heap)} MB; lateness in ms")
        for work in (nothing, python, one_long_call, child):
            for with_others in (False, True):
                late = [1000 * each for each in lateness(work, with_others)]
                share = [late[int(len(late) * part)] for part in (0.5, 0.99, 0.999)]
                which = "all threads real-time" if with_others else "the control thread alone"
                shown = " ".join(
                    f"{name} {value:6.2f}" for name, value in zip(("p50", "p99", "p99.9"), share, strict=True)
                )
                print(f"{work.__name__:14} {which:25} {shown}  worst {late[-1]:7.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
