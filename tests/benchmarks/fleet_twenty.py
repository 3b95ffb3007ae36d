"""What a simulated rig in a fleet costs: processor time and memory of its two processes, and of the operator's.

`python tests/benchmarks/fleet_twenty.py [RIGS] [SECONDS]`: all on this machine, with one operator who sees all. Time is
counted, not measured by the clock, so a busy machine changes little.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from fleet_bench import RigProcess, side_by_side
from processor_time import processor_time

from teleop.studio.fleet import Fleet

AT_ONCE = 4  # rigs that start together


def used(process: int) -> tuple[float, float]:
    """Processor time in s, and the memory that is its own in MB."""
    kept = [line.split() for line in Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()[1:]]
    own = sum(int(words[1]) for words in kept if words[0] in ("Private_Clean:", "Private_Dirty:"))
    return processor_time(process), own / 1024


def children(process: int) -> dict[str, int]:
    """The processes of a run by what they are."""
    found = {"control": process}
    for task in Path(f"/proc/{process}/task").iterdir():
        for child in (task / "children").read_text().split():
            line = Path(f"/proc/{child}/cmdline").read_bytes()
            for name, mark in (
                ("gateway", b"teleop.gateway"),
                ("planner", b"planning_process"),
                ("console", b"worker"),
            ):
                if mark in line:
                    found[name] = int(child)
    for worker in list(found.values())[1:]:
        for task in Path(f"/proc/{worker}/task").iterdir():
            for child in (task / "children").read_text().split():
                found["console worker"] = int(child)
    return found


def main(count: int, seconds: float) -> None:
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        names = [f"rig-{number}" for number in range(count)]
        rigs = [
            stack.enter_context(rig)
            for begin in range(0, count, AT_ONCE)
            for rig in side_by_side(lambda name: RigProcess(folder, name), names[begin : begin + AT_ONCE])
        ]
        fleet = stack.enter_context(Fleet([rig.endpoint for rig in rigs], memory=False))
        assert fleet.until(lambda: sum(rig.alive for rig in fleet.rigs) == count, 300), len(fleet.rigs)
        runs = [children(rig.process.pid) for rig in rigs]
        runs.append({"operator": os.getpid()})
        before = {process: used(process) for run in runs for process in run.values()}
        begin = time.monotonic()
        time.sleep(seconds)
        passed = time.monotonic() - begin
        figures: dict[str, list[tuple[float, float]]] = {}
        for run in runs:
            for name, process in run.items():
                if Path(f"/proc/{process}").exists():
                    spent, memory = used(process)
                    figures.setdefault(name, []).append(((spent - before[process][0]) / passed * 100, memory))
        alive = sum(rig.alive for rig in fleet.rigs)
        print(
            json.dumps({"rigs": count, "alive at the end": alive, "seconds": round(passed), "load": os.getloadavg()[0]})
        )
        for name, values in figures.items():
            each = [sum(value[which] for value in values) / len(values) for which in (0, 1)]
            print(f"{name:15} {each[0]:6.1f} % of a core  {each[1]:7.1f} MB  x {len(values)}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20, float(sys.argv[2]) if len(sys.argv) > 2 else 30.0)
