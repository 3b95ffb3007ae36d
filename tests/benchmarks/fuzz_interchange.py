"""Hunt: 100 000 hostile files of each format.

python tests/benchmarks/fuzz_interchange.py [FORMAT...] [COUNT [SKIPPED]]

SKIPPED are files of an earlier hunt, which this one goes on from. Each format runs in children of a few hundred files,
so that a library that crashes is seen and counted. Printed are the files that were taken for valid, the crashes of a
library (which `isolated` catches), the time and the memory.
"""

from __future__ import annotations

import os
import resource
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from interchange_fuzz import READERS, attack

from teleop.interchange.child import limit

BATCH = 500
LIBRARIES = ("usd", "otio")  # in C++: read with the limits that `isolated` sets, in smaller batches


def _child(name: str, seed: int, folder: Path, out: int, size: int) -> None:
    if name in LIBRARIES:
        limit()
    devnull = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devnull, 2 if name in LIBRARIES else devnull)
    try:
        taken = attack(name, size, seed, folder)
        os.write(out, str(taken).encode())
        os._exit(0)
    except BaseException as error:  # noqa: BLE001 - what no reader may raise, and interrupts
        os.write(out, f"{type(error).__name__}: {error}"[:300].encode())
        os._exit(1)


def hunt(name: str, count: int, skipped: int = 0) -> None:
    size = BATCH // 25 if name in LIBRARIES else BATCH
    begin, taken, crashes, faults = time.monotonic(), 0, 0, []
    with tempfile.TemporaryDirectory(dir="/dev/shm" if Path("/dev/shm").is_dir() else None) as folder:
        attack(name, 3, 0, Path(folder))  # loads the library once, for all children
        for seed in range(skipped // size + 1, (skipped + count) // size + 1):
            inner, outer = os.pipe()
            child = os.fork()
            if child == 0:
                _child(name, seed, Path(folder), outer, size)
            os.close(outer)
            text = os.read(inner, 1000).decode()
            os.close(inner)
            _, status = os.waitpid(child, 0)
            if os.WIFSIGNALED(status):
                crashes += 1
                faults.append(f"seed {seed}: signal {os.WTERMSIG(status)}")
            elif os.WEXITSTATUS(status):
                faults.append(f"seed {seed}: {text}")
            else:
                taken += int(text)
            if name in LIBRARIES and seed % (5000 // size) == 0:
                print(f"  {name}: {seed * size}, {time.monotonic() - begin:.0f} s", flush=True)
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
    print(
        f"{name}: {count} files, {taken} taken, {crashes} crashes, {time.monotonic() - begin:.0f} s, {memory} MB",
        flush=True,
    )
    for fault in faults[:10]:
        print(f"  {fault}", flush=True)


if __name__ == "__main__":
    names = [each for each in sys.argv[1:] if each in READERS] or list(READERS)
    numbers = [int(each) for each in sys.argv[1:] if each.isdigit()]
    for each in names:
        hunt(each, *(numbers or [100_000]))
