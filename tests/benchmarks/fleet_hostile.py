"""1e5 hostile messages to one rig by Zenoh: what moved, what failed, and how long a STOP took meanwhile.

`python tests/benchmarks/fleet_hostile.py [COUNT]`
"""

from __future__ import annotations

import json
import random
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from threading import Thread

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from fleet_bench import RigProcess
from fleet_fuzz import send

from teleop.studio.fleet import Fleet
from teleop.studio.stopping import stop
from teleop.studio.transport import opened


def main(count: int) -> None:
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        rig = stack.enter_context(RigProcess(folder, "cam-a"))
        fleet = stack.enter_context(Fleet([rig.endpoint], memory=False))
        assert fleet.until(lambda: [each for each in fleet.rigs if each.alive], 60)
        seen = fleet.rig("cam-a")
        before = {name: axis["commanded"] for name, axis in seen.state["axes"].items()}
        session = opened("client", connect=[rig.endpoint])
        stack.callback(session.close)
        sender = Thread(target=send, args=(session, "cam-a", random.Random(7), count), daemon=True)
        begin = time.monotonic()
        sender.start()
        stops: list[float] = []
        while sender.is_alive():
            asked = time.monotonic()
            assert stop(fleet, None, 10) == []
            stops.append(time.monotonic() - asked)
            sender.join(0.5)
        seconds = time.monotonic() - begin
        time.sleep(1)
        after = {name: axis["commanded"] for name, axis in seen.state["axes"].items()}
        troubles = [line["text"] for line in seen.state["messages"] if "gateway" in line["text"]]
        stops.sort()
        figures = {
            "messages": count,
            "per second": round(count / seconds),
            "moved": after != before,
            "alive": seen.alive,
            "run lives": rig.process.poll() is None,
            "gateway troubles": troubles,
            "holder": seen.state["holder"],
            "stop ms, median and worst": [round(stops[len(stops) // 2] * 1000), round(stops[-1] * 1000)],
        }
        print(json.dumps(figures))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
