"""A rig for tests of the page alone: it answers the console's commands as the door does, with plain kinematics.

It stands for `gateway.door_client.DoorClient`. For pictures its clock is set by hand: they are the same each time.
"""

from __future__ import annotations

import asyncio
import copy
import time
from collections.abc import AsyncIterator, Mapping
from typing import Any

AXES = {
    "pan": (-180.0, 180.0, 120.0),
    "tilt": (-56.0, 146.0, 90.0),
    "roll": (-30.0, 30.0, 60.0),
    "focus": (0.0, 1.0, 0.5),
}
PERIOD = 1 / 60
DEAD_MAN = 0.25


class ConsoleRig:
    """State out, commands in. `commands` are all that came, `sticks` all stick messages."""

    def __init__(self) -> None:
        self.at = dict.fromkeys(AXES, 0.0)
        self.speed = dict.fromkeys(AXES, 0.0)
        self.goal: dict[str, tuple[float, float]] = {}
        self.stick_at: dict[str, float] = {}
        self.stick_time = 0.0
        self.commands: list[dict[str, Any]] = []
        self.sticks: list[dict[str, Any]] = []
        self.began = time.monotonic()
        self.more: dict[str, Any] = {
            "holder": None, "holder_session": None, "asking": None,
            "stopped": False, "stopped_by": "", "stopped_at": None,
            "recording": False, "recording_s": 0.0, "camera": True,
            "move": None, "shoot": None, "keys": [], "presets": {},
            "range": 2, "ranges": [0.1, 0.35, 1.0], "follow": "lock", "focus_marks": {}, "manual": True, "inputs": [],
            "tracking": None,
            "sticks": {"missed": 0, "age_ms": None, "armed": False, "waits_for": ""}, "messages": [],
        }  # fmt: skip
        self.frozen: float | None = None  # the loop's time of a rig that stands still for a picture
        self.age_ms = 4.0
        self.quiet = False  # sends no states

    def turn(self, seconds: float) -> None:
        alive = time.monotonic() - self.stick_time < DEAD_MAN
        for axis, (low, high, fastest) in AXES.items():
            share = self.more["ranges"][self.more["range"] - 1]
            speed = self.stick_at.get(axis, 0.0) * fastest * share if alive else 0.0
            if axis in self.goal:
                target, pace = self.goal[axis]
                left = target - self.at[axis]
                speed = max(min(left / seconds, pace), -pace)
                if abs(left) < 1e-6:
                    del self.goal[axis]
            if self.more["stopped"]:
                speed = 0.0
            self.at[axis] = min(max(self.at[axis] + speed * seconds, low), high)
            self.speed[axis] = speed

    def state(self) -> dict[str, Any]:
        now = self.frozen if self.frozen is not None else time.monotonic() - self.began
        axes = {
            axis: {
                "measured": round(self.at[axis], 4), "measured_age_ms": 8, "commanded": round(self.at[axis], 4),
                "speed": round(self.speed[axis], 3), "unit": "" if axis == "focus" else "deg",
                "minimum": low, "maximum": high, "max_speed": fastest, "continuous": False, "driver": "",
            }
            for axis, (low, high, fastest) in AXES.items()
        }  # fmt: skip
        return {
            "rig": "Simulated rig", "tick": int(now * 100), "time": round(now, 3), "clock": 1_790_000_000.0 + now,
            "age_ms": 5000.0 if self.quiet else self.age_ms, "run": "running", "axes": axes,
            "links": {"gimbal": {"age_ms": 12, "ok": True}},
            **copy.deepcopy(self.more),
        }  # fmt: skip

    async def states(self) -> AsyncIterator[dict[str, Any]]:
        while True:
            await asyncio.sleep(1 / 30)
            if not self.quiet:
                yield self.state()

    async def run(self) -> None:
        while True:
            await asyncio.sleep(PERIOD)
            if self.frozen is None:
                self.turn(PERIOD)

    async def command(self, command: Mapping[str, Any], session: str, name: str, brief: bool = False) -> dict[str, Any]:
        self.commands.append({**command, "session": session})
        do = command["do"]
        free = ("take_control", "stop", "release_control")
        if do not in free and self.more["holder_session"] != session:
            return {"error": "take control first", "kind": "busy", "holder": self.more["holder"]}
        answer = getattr(self, f"_{do}", lambda *_: None)(command, session, name)
        return answer or {"ok": True, "id": len(self.commands)}

    def stick(self, message: Mapping[str, Any], session: str) -> None:
        self.sticks.append({**message, "session": session})
        if self.more["holder_session"] == session:
            self.stick_at, self.stick_time = dict(message["axes"]), time.monotonic()

    async def finished(self, id: Any) -> dict[str, Any]:  # noqa: A002 - the field's name in every message
        while self.goal:
            await asyncio.sleep(PERIOD)
        return {"ok": True}

    def closed(self, session: str) -> None:
        if self.more["holder_session"] == session:
            self.more.update(holder=None, holder_session=None)
            self.stick_at = {}

    def _take_control(self, command: Mapping[str, Any], session: str, name: str) -> dict[str, Any] | None:
        if self.more["holder_session"] in (None, session):
            self.more.update(holder=name, holder_session=session)
            return None
        if command.get("ask"):
            self.more["asking"] = name
            return None
        return {"error": "busy", "kind": "busy", "holder": self.more["holder"]}

    def _release_control(self, *_: Any) -> None:
        self.more.update(holder=None, holder_session=None, asking=None)

    def _deny_control(self, *_: Any) -> None:
        self.more["asking"] = None

    def _stop(self, _: Any, __: str, name: str) -> None:
        self.goal = {}
        self.more.update(stopped=True, stopped_by=name, stopped_at=1_790_000_000.0)

    def _clear(self, *_: Any) -> None:
        self.more.update(stopped=False, stopped_by="", stopped_at=None)

    def _jog(self, command: Mapping[str, Any], *_: Any) -> None:
        axis = command["axis"]
        self.goal[axis] = (self.at[axis] + command["by"], AXES[axis][2])

    def _goto(self, command: Mapping[str, Any], *_: Any) -> None:
        for axis, to in command["axes"].items():
            self.goal[axis] = (to, max(abs(to - self.at[axis]) / max(command.get("seconds", 1), 0.1), 1e-6))

    def _focus(self, command: Mapping[str, Any], *_: Any) -> None:
        self.goal["focus"] = (command["to"], 0.5)

    def _focus_mark_store(self, command: Mapping[str, Any], *_: Any) -> None:
        self.more["focus_marks"][command["name"]] = round(self.at["focus"], 3)

    def _focus_mark_recall(self, command: Mapping[str, Any], *_: Any) -> None:
        self.goal["focus"] = (self.more["focus_marks"][command["name"]], 0.5)

    def _preset_store(self, command: Mapping[str, Any], *_: Any) -> None:
        self.more["presets"][str(command["number"])] = {axis: round(value, 3) for axis, value in self.at.items()}

    def _preset_delete(self, command: Mapping[str, Any], *_: Any) -> None:
        self.more["presets"].pop(str(command["number"]), None)

    def _preset_recall(self, command: Mapping[str, Any], *_: Any) -> dict[str, Any] | None:
        preset = self.more["presets"].get(str(command["number"]))
        if preset is None:
            return {"error": f"preset {command['number']} is empty", "kind": "refused"}
        positions = {axis: value for axis, value in preset.items() if axis in AXES}
        return self._goto({"axes": positions, "seconds": command.get("seconds", 2)})

    def _set_key(self, *_: Any) -> None:
        self.more["keys"].append({axis: round(value, 3) for axis, value in self.at.items()})

    def _delete_key(self, command: Mapping[str, Any], *_: Any) -> None:
        del self.more["keys"][command["number"] - 1]

    def _clear_keys(self, *_: Any) -> None:
        self.more["keys"] = []

    def _range(self, command: Mapping[str, Any], *_: Any) -> None:
        self.more["range"] = command["number"]

    def _follow(self, command: Mapping[str, Any], *_: Any) -> None:
        self.more["follow"] = command["mode"]

    def _record(self, *_: Any) -> None:
        self.more["recording"] = True

    def _stop_recording(self, *_: Any) -> None:
        self.more["recording"] = False

    def _track(self, command: Mapping[str, Any], *_: Any) -> None:
        self.more["tracking"]["follows"] = command["source"]

    def _abort(self, *_: Any) -> None:
        if self.more["tracking"]:
            self.more["tracking"]["follows"] = None

    def seen(self, session: str) -> None:
        """A client has sent anything."""
