"""What a take is on disk: an MCAP file of JSON channels, each with a JSON Schema, so that Foxglove plots it as it is.

The time of a message is the wall clock at the start plus the loop's time since, so the loop's own grid can be read back
exactly. A reading has the time of its measurement, not of its arrival. Floats are rounded to more digits than planning
needs and few enough to compress: an error of position has ten million times its size in the jerk of a quintic through
two ticks. A value that does not change is not written again, and a `StateTarget` that was met exactly is written
without its numbers, because they would double the file.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from typing import Any, BinaryIO

from teleop.core.axes import Axis, Limits, State
from teleop.core.events import DeviceCommand, DialInput, Exposure, Tick, TickEvent
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, VelocityTarget
from teleop.recording.played import PlaceWriter, Played, SequenceFacts

ABOUT, END = "teleop take", "teleop end"  # the names of the metadata records
FORMAT = "1"
CUT = "cut"  # the result of a run whose end is not recorded: of a file that was recovered
DRONE_PERIOD = 0.1  # s between two states of a drone, unless it is taken or given back meanwhile
CHUNK = 1 << 20  # bytes of messages after which a chunk is written even without a flush
PLACES = (12, 10, 8)  # decimals of a position, velocity, acceleration
SETPOINT_PLACES = 6  # decimals of what was asked for
SAME = 1e-9  # units: a reference that close to the motion was obeyed
LIMITS = ("minimum", "maximum", "velocity", "acceleration", "jerk")

NO_SEQUENCE = SequenceFacts()

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


@dataclass(frozen=True)
class About:
    """The description at the start of a take; `started` is in s since 1970, the axes are those of `limits`."""

    rig: str
    title: str
    started: float
    limits: Mapping[Axis, Limits]
    version: str
    sequence: SequenceFacts = NO_SEQUENCE

    def record(self) -> dict[str, str]:
        """As the strings of a metadata record; a limit that there is not is null."""
        axes = {axis.value: {name: _finite(getattr(of, name)) for name in LIMITS} for axis, of in self.limits.items()}
        plain = {"format": FORMAT, "rig": self.rig, "title": self.title, "version": self.version}
        return {**plain, "started": repr(self.started), "axes": json.dumps(axes), **self.sequence.record()}


class TakeWriter:
    """Turns ticks into messages on `stream`, which needs `write`, `flush` and `tell`; raises what the stream raises."""

    def __init__(self, stream: BinaryIO, about: About) -> None:
        from mcap.writer import Writer  # with its compressors, only where something is recorded

        self._writer = Writer(stream, chunk_size=CHUNK, enable_data_crcs=True)
        self._writer.start(profile="", library=f"teleop {about.version}")
        self._writer.add_metadata(ABOUT, about.record())
        self._started = round(about.started * 1e9)
        self._origin = math.nan
        self._channels: dict[str, int] = {}
        self._last_written: dict[str, bytes] = {}
        self._drone_due, self._stage = -math.inf, ""  # when the drone is next written down, and its last stage
        self._reading_times: dict[Axis, float] = {}
        self._places = PlaceWriter()
        self.ticks, self.seconds = 0, 0.0
        for topic, schema in SCHEMAS.items():
            known = self._writer.register_schema(f"teleop.{schema['title']}", "jsonschema", _json(schema))
            self._channels[topic] = self._writer.register_channel(topic, "json", known)

    def add(self, tick: Tick, status: object) -> None:
        """What is new in this tick, and in the operator's status at that time."""
        if self.ticks == 0:
            self._origin = tick.time
        self.seconds = tick.time - self._origin
        self.ticks += 1
        self._message("/motion", tick.time, {axis.value: _state(state) for axis, state in tick.motion.items()})
        setpoints = {axis.value: _setpoint(setpoint, tick.motion.get(axis)) for axis, setpoint in tick.demand.items()}
        self._change("/demand", tick.time, setpoints)
        self._measured(tick)
        for event in tick.actions:
            self._message("/actions", tick.time, _action(event))
        if isinstance(status, Played):
            self._add_played(tick.time, status)
        elif status is not None:
            self._add_status(tick.time, plain(status))

    def flush(self) -> None:
        """Everything so far goes to the stream; a reader of a file that is cut later will have it."""
        self._writer.flush()

    def end(
        self, result: str, reasons: Sequence[str], dropped: int, links: Mapping[str, Mapping[str, int]] | None = None
    ) -> None:
        """How the run ended, what each of its links counted, and the index."""
        self._writer.flush()
        self._writer.add_metadata(END, ending_record(result, reasons, dropped, self.ticks, self.seconds, links or {}))
        self._writer.finish()

    def _add_played(self, time: float, played: Played) -> None:
        mark = self._places.mark(time, played.place)
        if mark is not None:
            self._message("/passes", time, {"pass": mark.number, "time": round(mark.place, 6)})
        if played.plan:
            positions = {axis.value: round(position, PLACES[2]) for axis, position in played.plan.items()}
            self._message("/plan", time, positions)
        if played.firmware:
            self._change("/firmware", time, played.firmware)

    def _add_status(self, time: float, status: Any) -> None:
        """A status; sticks and the drone in it have topics of their own."""
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
        data = _json(content)
        if data != self._last_written.get(topic):
            self._last_written[topic] = data
            self._write(topic, time, data)

    def _message(self, topic: str, time: float, content: object) -> None:
        self._write(topic, time, _json(content))

    def _write(self, topic: str, time: float, data: bytes) -> None:
        nanoseconds = self._started + round((time - self._origin) * 1e9)
        self._writer.add_message(self._channels[topic], nanoseconds, data, nanoseconds)


def ending_record(
    result: str,
    reasons: Sequence[str],
    dropped: int,
    ticks: int,
    seconds: float,
    links: Mapping[str, Mapping[str, int]],
) -> dict[str, str]:
    """The strings of the metadata record that ends a take."""
    counts = {"dropped": str(dropped), "ticks": str(ticks), "seconds": f"{seconds:.2f}"}
    return {"result": result, "reasons": json.dumps(list(reasons)), **counts, "links": json.dumps(links)}


def _json(content: object) -> bytes:
    return json.dumps(content, separators=(",", ":")).encode()


def _finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None


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
