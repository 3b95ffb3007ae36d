"""The topics of a take and what each tick writes to them: JSON, with a schema each; the same in a file and live.

Floats are rounded to more digits than planning needs and few enough to compress: an error of position has ten million
times its size in the jerk of a quintic through two ticks. A value that does not change is not written again, and a
`StateTarget` that was met exactly is written without its numbers, because they would double a file.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

from teleop.core.axes import Axis, State
from teleop.core.events import DeviceCommand, DialInput, Exposure, Tick, TickEvent
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, VelocityTarget
from teleop.recording.played import PlaceWriter, Played

DRONE_PERIOD = 0.1  # s between two states of a drone, unless it is taken or given back meanwhile
PLACES = (12, 10, 8)  # decimals of a position, velocity, acceleration
SETPOINT_PLACES = 6  # decimals of what was asked for
SAME = 1e-9  # units: a reference that close to the motion was obeyed

_NUMBER = {"type": "number"}
_STATE = {"type": "object", "properties": dict.fromkeys(("position", "velocity", "acceleration"), _NUMBER)}
_SETPOINT = {
    "type": "object",
    "properties": {
        "wish": {"enum": ["cruise", "goto", "follow", "halt"]},
        **dict.fromkeys(("position", "velocity", "acceleration", "jerk", "arrive"), _NUMBER),
    },
}


def _schema(title: str, text: str, each: Mapping[str, Any] | None) -> Mapping[str, Any]:
    properties = {} if each is None else {"properties": {axis.value: each for axis in Axis}}
    return {"title": title, "description": text, "type": "object", **properties}


_UNITS = "degrees (focus 0..1, sticks -1..1), per s, per s2"
SCHEMAS: Mapping[str, Mapping[str, Any]] = {
    "/motion": _schema("Motion", f"Where each axis was commanded to be: {_UNITS}.", _STATE),
    "/demand": _schema(
        "Demand", f"What each axis was asked for, on change; a follow without numbers is /motion: {_UNITS}.", _SETPOINT
    ),
    "/measured": _schema(
        "Measured", "Where each axis was at the time of the message, in degrees (focus 0..1).", _NUMBER
    ),
    "/sticks": _schema("Sticks", "Deflection of each axis after dead zone and expo, -1..1, on change.", _NUMBER),
    "/actions": {
        "title": "Action",
        "description": "Something done once: a camera's action, or a command to a device.",
        "type": "object",
        "properties": {"action": {"type": "string"}, "words": {"type": "string"}, "speed": _NUMBER, "frame": _NUMBER},
    },
    "/drone": _schema(
        "Drone", "The drone's own telemetry, ten times a second: deg, m, m/s, %; null where it sent none.", None
    ),
    "/passes": {
        "title": "Passes",
        "description": "Which pass of a sequence is played (0: none), and where in it (s), on change: it plays on.",
        "type": "object",
        "properties": {"pass": _NUMBER, "time": _NUMBER},
    },
    "/plan": _schema(
        "Plan", "Where the sequence itself is, while a learned correction is added to it, in degrees.", _NUMBER
    ),
    "/firmware": _schema("Firmware", "The version of the gimbal on each link, as it answers.", None),
    "/status": _schema("Status", "The operator's state, on change: stops, recalls, inputs and their faults.", None),
}


class TopicWriter:
    """`write` takes each message: its topic, the loop's time in s, and JSON."""

    def __init__(self, write: Callable[[str, float, bytes], object]) -> None:
        self._write = write
        self._last_written: dict[str, bytes] = {}
        self._drone_due, self._stage = -math.inf, ""  # when the drone is next written down, and its last stage
        self._reading_times: dict[Axis, float] = {}
        self._places = PlaceWriter()

    def tick(self, tick: Tick) -> None:
        """What is new in this tick."""
        self._message("/motion", tick.time, {axis.value: _state(state) for axis, state in tick.motion.items()})
        setpoints = {axis.value: _setpoint(setpoint, tick.motion.get(axis)) for axis, setpoint in tick.demand.items()}
        self._change("/demand", tick.time, setpoints)
        self._measured(tick)
        for event in tick.actions:
            self._message("/actions", tick.time, _action(event))

    def again(self, topic: str) -> None:
        """Write what the topic has at its next occasion, changed or not."""
        self._last_written.pop(topic, None)

    def played(self, time: float, played: Played) -> None:
        """What of a sequence is played."""
        mark = self._places.mark(time, played.place)
        if mark is not None:
            self._message("/passes", time, {"pass": mark.number, "time": round(mark.place, 6)})
        if played.plan:
            positions = {axis.value: round(position, PLACES[2]) for axis, position in played.plan.items()}
            self._message("/plan", time, positions)
        if played.firmware:
            self._change("/firmware", time, played.firmware)

    def status(self, time: float, status: Any) -> None:
        """A status, plain; sticks and the drone in it have topics of their own."""
        if isinstance(status, dict):
            deflections, drone = status.pop("deflections", None), status.pop("drone", None)
            if deflections is not None:
                self._change("/sticks", time, deflections)
            if drone is not None and (time >= self._drone_due or drone["stage"] != self._stage):
                self._drone_due, self._stage = time + DRONE_PERIOD, drone["stage"]
                self._change("/drone", time, drone)
        if status:
            self._change("/status", time, status)

    def _measured(self, tick: Tick) -> None:
        """The new readings, those of one time in one message."""
        new: dict[float, dict[str, float]] = {}
        for axis, reading in tick.reported.items():
            if reading.time != self._reading_times.get(axis):
                self._reading_times[axis] = reading.time
                new.setdefault(reading.time, {})[axis.value] = round(reading.position, 6)
        for time, positions in new.items():
            self._message("/measured", time, positions)

    def _change(self, topic: str, time: float, content: object) -> None:
        data = as_json(content)
        if data != self._last_written.get(topic):
            self._last_written[topic] = data
            self._write(topic, time, data)

    def _message(self, topic: str, time: float, content: object) -> None:
        self._write(topic, time, as_json(content))


def as_json(content: object) -> bytes:
    return json.dumps(content, separators=(",", ":")).encode()


def _state(state: State) -> dict[str, float]:
    p, v, a = state
    return {
        "position": round(p, PLACES[0]),
        "velocity": round(v, PLACES[1]) if v else 0,
        "acceleration": round(a, PLACES[2]) if a else 0,
    }


def _setpoint(setpoint: Setpoint, state: State | None) -> dict[str, Any]:
    match setpoint:
        case StateTarget():
            obeyed = state is not None and all(abs(a - b) <= SAME for a, b in zip(setpoint, state, strict=True))
            return {"wish": "follow", **({} if obeyed else _state(State(*setpoint)))}
        case VelocityTarget() | PositionTarget():
            given = {name: value for name, value in setpoint._asdict().items() if value is not None}
            rounded = {name: round(value, SETPOINT_PLACES) for name, value in given.items()}
            return {"wish": "cruise" if isinstance(setpoint, VelocityTarget) else "goto", **rounded}
        case _:
            return {"wish": "halt"}


def _action(event: TickEvent) -> dict[str, Any]:
    match event:
        case DeviceCommand():
            return {"action": "told", "words": str(event)}
        case DialInput(speed):
            return {"action": "dialled", "speed": speed}
        case Exposure(frame, step):
            return {"action": step.value, "frame": frame}
        case _:
            return {"action": event.value}


def plain(value: object) -> Any:
    """A frozen dataclass, and what is in it, as JSON has it; what JSON has no word for, as text."""
    if is_dataclass(value) and not isinstance(value, type):
        return {each.name: plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Mapping):
        return {str(plain(key)): plain(each) for key, each in value.items()}
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return plain(value._asdict())  # type: ignore[attr-defined] - a NamedTuple, which has no type of its own
    if isinstance(value, Sequence | set | frozenset):
        return [plain(each) for each in value]
    return str(value)
