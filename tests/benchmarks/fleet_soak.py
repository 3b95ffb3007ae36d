"""How many states of three rigs reach an operator in a long time, and why each other one did not.

`python tests/benchmarks/fleet_soak.py MINUTES FILE [BUSY]`: a line of JSON each minute and at the end, in FILE; BUSY
processes load the machine meanwhile. Each state has a number, so a lost one is a gap. By design a state is dropped
where the queue of its link is full, and where the link was silent for longer than the lease: then one side closes it,
and what is on its way is gone. Zenoh's own log of both sides tells of each: any other loss is `unexplained`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

import zenoh
from fleet_bench import RigProcess
from zenoh_log import FILTER, Closed, Dropped, python_path, told

from teleop.studio.fleet import Fleet
from teleop.studio.link import Link
from teleop.studio.transport import LEASE

NAMES = ("cam-a", "cam-b", "cam-c")
BUSY = "while True: pass"


class Gap(NamedTuple):
    """States `first` to `last` did not come: after one that was sent at `begun`, and before one that came at `ended`.

    Times are in s of the wall clock.
    """

    rig: str
    first: int
    last: int
    begun: float
    ended: float


class Counting(Fleet):
    """Counts the states of each rig, and keeps the gaps between their numbers."""

    def __init__(self, endpoints: list[str]) -> None:
        super().__init__(endpoints, memory=False)
        self.came: dict[str, int] = dict.fromkeys(NAMES, 0)
        self.restarts: dict[str, int] = dict.fromkeys(NAMES, 0)
        self.newest: dict[str, tuple[int, float, float]] = {}  # number, when it was sent and came (s)
        self.silence: dict[str, float] = dict.fromkeys(NAMES, 0.0)
        self.gaps: list[Gap] = []

    def heard_state(self, link: Link, rig: str, state: dict[str, Any], arrived: float) -> None:
        super().heard_state(link, rig, state, arrived)
        wall, seq = time.time() - time.monotonic(), state["seq"]
        self.came[rig] += 1
        before, sent, at = self.newest.get(rig, (seq - 1, 0.0, arrived))
        if seq <= before:  # the gateway was started again, and counts anew
            self.restarts[rig] += 1
        elif seq > before + 1:
            self.gaps.append(Gap(rig, before + 1, seq - 1, sent + wall, arrived + wall))
        self.newest[rig] = (seq, state["time"], arrived)
        self.silence[rig] = max(self.silence[rig], arrived - at)

    def sessions(self) -> dict[str, str]:
        """The rig that each session of this operator leads to."""
        links = {rig.name: rig.link for rig in self.rigs}
        return {str(link._session.zid()): name for name, link in links.items() if link is not None and link._session}


def explained(gaps: list[Gap], events: list[Dropped | Closed], sessions: dict[str, str]) -> dict[str, Any]:
    """How many states were lost, and how many of them by each of the reasons; the gaps that have none."""
    dropped = {(event.rig, event.seq) for event in events if isinstance(event, Dropped)}
    closed = [
        (event.at, sessions[session])
        for event in events
        if isinstance(event, Closed)
        for session in event.sessions & sessions.keys()
    ]
    found = {"lost": 0, "congested": 0, "link closed": 0, "closed links": len(closed), "unexplained": []}
    for gap in gaps:
        missing = range(gap.first, gap.last + 1)
        congested = sum((gap.rig, seq) in dropped for seq in missing)
        found["lost"] += len(missing)
        found["congested"] += congested
        if congested == len(missing):
            continue
        if any(rig == gap.rig and gap.begun <= at <= gap.ended for at, rig in closed):
            found["link closed"] += len(missing) - congested
        else:
            nearest = min((abs(at - gap.begun) for at, rig in closed if rig == gap.rig), default=None)
            found["unexplained"].append({**gap._asdict(), "closed link s away": nearest})
    return found


def main(minutes: float, file: str, busy: int) -> None:
    os.environ["RUST_LOG"] = FILTER
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        os.environ["PYTHONPATH"] = python_path(folder)
        rigs = [stack.enter_context(RigProcess(folder, name)) for name in NAMES]
        os.dup2(os.open(folder / "operator.log", os.O_WRONLY | os.O_CREAT, 0o600), 1)
        zenoh.try_init_log_from_env()
        fleet = stack.enter_context(Counting([rig.endpoint for rig in rigs]))
        out = stack.enter_context(Path(file).open("w", encoding="utf-8"))
        assert fleet.until(lambda: sum(rig.alive for rig in fleet.rigs) == len(NAMES), 60)
        sessions = fleet.sessions()
        for _ in range(busy):
            stack.callback(subprocess.Popen([sys.executable, "-c", BUSY]).kill)
        begin = time.monotonic()
        while (passed := time.monotonic() - begin) < minutes * 60:
            time.sleep(min(60.0, minutes * 60 - passed))
            line = {
                "minutes": round((time.monotonic() - begin) / 60, 2),
                "load": round(os.getloadavg()[0], 1),
                "rigs live": [rig.process.poll() is None for rig in rigs],
                "ended": {rig.name: rig.last_lines() for rig in rigs if rig.process.poll() is not None},
                "sent": {name: number for name, (number, _, _) in sorted(fleet.newest.items())},
                "came": fleet.came,
                "silence": {name: round(each, 3) for name, each in fleet.silence.items()},
                "restarts": fleet.restarts,
                "lease ms": LEASE,
                **explained(fleet.gaps, list(told(folder)), sessions),
            }
            out.write(json.dumps(line) + "\n")
            out.flush()


if __name__ == "__main__":
    main(float(sys.argv[1]), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 0)
