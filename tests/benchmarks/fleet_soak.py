"""How many states of three rigs reach an operator in a long time: every one that the rig has sent, or how many not.

`python tests/benchmarks/fleet_soak.py MINUTES FILE`: a line of JSON each minute and at the end, in FILE. Each state has
a number, so a lost one is a gap. By design a state is dropped only where a link is congested; here it is not.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from fleet_bench import RigProcess

from teleop.studio.fleet import Fleet
from teleop.studio.link import Link

NAMES = ("cam-a", "cam-b", "cam-c")


class Counting(Fleet):
    """Counts the states of each rig: the first and newest number, how many came, and the longest silence (s)."""

    def __init__(self, endpoints: list[str]) -> None:
        super().__init__(endpoints, memory=False)
        self.counts: dict[str, dict[str, float]] = {}

    def heard_state(self, link: Link, rig: str, state: dict[str, Any], arrived: float) -> None:
        super().heard_state(link, rig, state, arrived)
        new = {"first": state["seq"], "newest": state["seq"] - 1, "came": 0, "gaps": 0, "silence": 0.0, "at": arrived}
        count = self.counts.setdefault(rig, new)
        count["gaps"] += max(0, state["seq"] - count["newest"] - 1)
        count["newest"], count["came"] = state["seq"], count["came"] + 1
        count["silence"], count["at"] = max(count["silence"], arrived - count["at"]), arrived


def main(minutes: float, file: str) -> None:
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        rigs = [stack.enter_context(RigProcess(folder, name)) for name in NAMES]
        fleet = stack.enter_context(Counting([rig.endpoint for rig in rigs]))
        out = stack.enter_context(Path(file).open("w", encoding="utf-8"))
        begin = time.monotonic()
        while (passed := time.monotonic() - begin) < minutes * 60:
            time.sleep(min(60.0, minutes * 60 - passed))
            lives = [rig.process.poll() is None for rig in rigs]
            sent = {name: each["newest"] - each["first"] + 1 for name, each in fleet.counts.items()}
            lost = {name: sent[name] - each["came"] for name, each in fleet.counts.items()}
            line = {"minutes": round((time.monotonic() - begin) / 60, 2), "rigs live": lives, "lost": lost}
            out.write(json.dumps({**line, "counts": fleet.counts}) + "\n")
            out.flush()


if __name__ == "__main__":
    main(float(sys.argv[1]), sys.argv[2])
