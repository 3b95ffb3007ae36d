"""An operator in a process of its own: pans a rig by a stick and prints what it sees, a JSON line for each change.

`python fleet_pan.py CREDENTIALS RIG ENDPOINT...`; a line on its input is a command: `pan SPEED`, `take`, `stop`.
"""

from __future__ import annotations

import json
import sys
import threading
from time import monotonic
from typing import Any

from hands import FakeInput

from teleop.core.axes import Axis
from teleop.core.operator_input import Command
from teleop.studio.credentials import load
from teleop.studio.fleet import Fleet
from teleop.studio.sticks import RigSticks
from teleop.studio.stopping import stop


def main(credentials: str, name: str, *endpoints: str) -> None:
    hand, over = FakeInput(), threading.Event()
    with Fleet(endpoints, load(credentials) if credentials else None, memory=False) as fleet:

        def obey() -> None:
            for line in sys.stdin:
                do, _, rest = line.strip().partition(" ")
                if do == "pan":
                    hand.deflections = {Axis.PAN: float(rest)} if float(rest) else {}
                elif do == "take":
                    hand.press(Command.ENABLE)
                elif do == "stop":
                    say({"missed": stop(fleet, None, float(rest or 3))})
            over.set()

        assert fleet.until(lambda: any(rig.name == name and rig.alive for rig in fleet.rigs), 60), fleet.problems
        with RigSticks(fleet, name, [hand], lambda line: say({"line": line})) as sticks:
            threading.Thread(target=obey, daemon=True).start()
            before: Any = None
            while not over.is_set():
                due = sticks.turn()
                state = fleet.rig(name).state
                speed = state["axes"]["pan"]["speed"]
                seen = {
                    "alive": {rig.name: rig.alive for rig in fleet.rigs},
                    "moves": abs(speed) > 0.5,
                    "armed": state["sticks"]["armed"],
                    "holder": state["holder"],
                    "stopped": {rig.name: rig.stopped for rig in fleet.rigs},
                }
                if seen != before:
                    before = seen
                    say(seen)
                fleet.until(lambda: False, max(0.0, due - monotonic()))


def say(what: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps({"time": monotonic(), **what}) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
