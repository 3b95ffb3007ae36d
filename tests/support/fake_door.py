"""A door without a rig behind it, for tests of the console: it keeps what it is told, and has a state to show.

`python tests/support/fake_door.py [--token T] [--port N]` serves the console on one, for work on the page.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import time
from collections.abc import AsyncIterator, Mapping
from typing import Any

from teleop.door.messages import CommandError, checked

NEEDS_NO_CONTROL = ("take_control", "release_control", "stop")
AXES = {"pan": (-180.0, 180.0, "deg"), "tilt": (-45.0, 125.0, "deg"), "roll": (-30.0, 30.0, "deg"), "focus": (0, 1, "")}


class FakeDoor:
    """`commands` are (command, session, name) in their order, `sticks` (message, session).

    `answers` are errors to give by command instead of obeying. Actions take `action_seconds`. A `lost` one answers
    nothing. What an axis measures is what was last commanded; a stick moves its axis by 30 units/s.
    """

    def __init__(self) -> None:
        self.commands: list[tuple[dict[str, Any], str, str]] = []
        self.sticks: list[tuple[dict[str, Any], str]] = []
        self.seen_sessions: list[str] = []
        self.closed_sessions: list[str] = []
        self.answers: dict[str, dict[str, Any]] = {}
        self.action_seconds = 0.05
        self.deaf_to_stop = 0  # STOPs that are answered with "lost" before one is obeyed
        self.positions = dict.fromkeys(AXES, 0.0)
        self.holder, self.holder_session = None, None
        self.stopped, self.stopped_by, self.stopped_at = False, "", None
        self.presets: dict[str, dict[str, float]] = {}
        self.keys: list[dict[str, float]] = []
        self.recording, self.range, self.follow, self.move = False, 1, "", None
        self.tick = 0
        self._changed: asyncio.Condition = asyncio.Condition()
        self._ends: dict[int, asyncio.Task[dict[str, Any]]] = {}
        self._started = time.monotonic()

    def state(self) -> dict[str, Any]:
        axes = {
            name: {
                "measured": self.positions[name],
                "measured_age_ms": 10.0,
                "commanded": self.positions[name],
                "speed": 0.0,
                "unit": unit,
                "minimum": minimum,
                "maximum": maximum,
                "max_speed": 60.0,
                "continuous": False,
                "driver": "",
            }
            for name, (minimum, maximum, unit) in AXES.items()
        }
        return {
            "rig": "fake",
            "tick": self.tick,
            "time": round(time.monotonic() - self._started, 3),
            "clock": time.time(),
            "age_ms": 8.0,
            "run": "running",
            "axes": axes,
            "holder": self.holder,
            "holder_session": self.holder_session,
            "asking": None,
            "stopped": self.stopped,
            "stopped_by": self.stopped_by,
            "stopped_at": self.stopped_at,
            "recording": self.recording,
            "recording_s": 0.0,
            "camera": True,
            "move": self.move,
            "shoot": None,
            "keys": list(self.keys),
            "presets": {number: dict(axes) for number, axes in self.presets.items()},
            "range": self.range,
            "ranges": [0.1, 0.5, 1.0],
            "follow": self.follow,
            "focus_marks": {},
            "inputs": [],
            "links": {"gimbal": {"age_ms": 12.0, "ok": True}},
            "sticks": {"missed": 0, "age_ms": None, "armed": True, "waits_for": ""},
            "messages": [],
        }

    async def states(self) -> AsyncIterator[dict[str, Any]]:
        before = -1
        while True:
            if before != self.tick:
                before = self.tick
                yield self.state()
            await asyncio.sleep(0.005)

    async def command(self, command: Mapping[str, Any], session: str, name: str, brief: bool = False) -> dict[str, Any]:
        do = str(command["do"])
        self.commands.append((dict(command), session, name))
        if do in self.answers:
            return self.answers[do]
        if do == "stop":
            if self.deaf_to_stop:
                self.deaf_to_stop -= 1
                return {"error": "no answer", "kind": "lost"}
            self.stopped, self.stopped_by, self.stopped_at = True, name, time.time()
            self.tick += 1
            return {"ok": True, "id": 0}
        try:
            checked({**command, "id": 1, "session": session, "person": name})
        except CommandError as error:
            return {"error": str(error), "kind": "invalid"}
        if self.holder_session not in (None, session) and do not in NEEDS_NO_CONTROL[1:]:
            return {"error": f"{self.holder} has control", "kind": "busy", "holder": self.holder}
        if self.holder_session is None and do not in NEEDS_NO_CONTROL and not brief:
            return {"error": "take control first", "kind": "busy", "holder": None}
        number = len(self.commands)
        if problem := self._obey(do, command, session, name):
            return problem
        self.tick += 1
        self._ends[number] = asyncio.create_task(self._end(do))
        return {"ok": True, "id": number}

    def _obey(self, do: str, command: Mapping[str, Any], session: str, name: str) -> dict[str, Any] | None:
        if do == "take_control":
            self.holder, self.holder_session = name, session
        elif do == "release_control" and self.holder_session == session:
            self.holder = self.holder_session = None
        elif do == "clear":
            self.stopped, self.stopped_by, self.stopped_at = False, "", None
        elif do == "goto":
            for axis, position in command["axes"].items():
                if axis not in AXES:
                    return {"error": f"fake has no axis {axis}", "kind": "refused"}
                if not AXES[axis][0] <= position <= AXES[axis][1]:
                    return {"error": f"goto: {axis}={position:g} is outside the soft limits", "kind": "refused"}
            self.positions |= command["axes"]
        elif do == "jog":
            self.positions[command["axis"]] += command["by"]
        elif do == "preset_store":
            self.presets[str(command["number"])] = dict(self.positions)
        elif do == "preset_recall":
            self.positions |= self.presets.get(str(command["number"]), {})
        elif do == "preset_delete":
            self.presets.pop(str(command["number"]), None)
        elif do == "set_key":
            self.keys.append(dict(self.positions))
        elif do == "clear_keys":
            self.keys.clear()
        elif do in ("record", "stop_recording"):
            self.recording = do == "record"
        elif do == "range":
            self.range = command["number"]
        elif do == "follow":
            self.follow = command["mode"]
        return None

    async def _end(self, do: str) -> dict[str, Any]:
        await asyncio.sleep(self.action_seconds)
        return {"ok": True}

    async def finished(self, number: int) -> dict[str, Any]:
        return await self._ends[number]

    def stick(self, message: Mapping[str, Any], session: str) -> None:
        checked({**message, "do": "stick", "id": 0, "session": session})
        self.sticks.append((dict(message), session))
        if session == self.holder_session and not self.stopped:
            for axis, share in message["axes"].items():
                if axis in self.positions and isinstance(share, int | float):
                    self.positions[axis] += 0.6 * max(-1.0, min(1.0, share))
        self.tick += 1

    def seen(self, session: str) -> None:
        self.seen_sessions.append(session)

    def closed(self, session: str) -> None:
        self.closed_sessions.append(session)
        if session == self.holder_session:
            self.holder = self.holder_session = None
            self.tick += 1


async def main() -> None:
    from teleop.console.invitation import as_json
    from teleop.console.server import serve
    from teleop.console.settings import ConsoleSettings, listen, with_tokens

    parser = argparse.ArgumentParser()
    parser.add_argument("--token", default="")
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--moves", default=".")
    parser.add_argument("--takes", default=".")
    options = parser.parse_args()
    asked = ConsoleSettings(port=options.port, token=options.token, moves=options.moves, takes=options.takes)
    listener, settings = listen(with_tokens(asked))
    sys.stdout.write(json.dumps(as_json(settings)) + "\n")
    sys.stdout.flush()
    door = FakeDoor()

    async def ticking() -> None:
        while True:
            await asyncio.sleep(0.02)
            door.tick += 1

    await asyncio.gather(serve(settings, door, listener), ticking())


if __name__ == "__main__":
    asyncio.run(main())
