"""The state of a rig for the ring, made each tick by the control thread: plain values, some only once they change."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from teleop.core.axes import Axis, Limits
from teleop.core.clock import date
from teleop.core.events import Tick
from teleop.devices.connection import Connection
from teleop.door.ring import RingWriter
from teleop.door.states import StatePacker
from teleop.door.ticks import as_plain
from teleop.manual.status import OperatorStatus
from teleop.plots.numbers import finite
from teleop.remote.desk import Desk

MESSAGES = 10  # of the newest
LONGEST = 200  # characters of each
PRESETS = 200  # that a state has room for
QUIET = 1.5  # s without a frame from a device, after which its link is not ok


class Shown(Protocol):
    """What a state has beside the axes and who has control."""

    @property
    def status(self) -> OperatorStatus: ...

    @property
    def stopped_by(self) -> str: ...

    @property
    def changes(self) -> object:
        """Another value after each change of the keys and presets."""
        ...

    @property
    def keys(self) -> Sequence[Mapping[str, float]]: ...

    @property
    def presets(self) -> Mapping[str, Mapping[str, Any]]: ...

    @property
    def focus_marks(self) -> Mapping[str, float]: ...

    def drivers(self) -> Mapping[Axis, str]:
        """What moves an axis that no input does."""
        ...

    @property
    def errors(self) -> Mapping[str, Any] | None:
        """Of the passes of the move that plays, or played last: another object after each change."""
        ...

    @property
    def battery(self) -> float | None:
        """In %, None where no device reports it."""
        ...

    def move(self, now: float) -> Mapping[str, Any] | None: ...

    def shoot(self, now: float) -> Mapping[str, Any] | None: ...


@dataclass(frozen=True)
class Parts:
    """What a state is made of."""

    rig: str
    limits: Mapping[Axis, Limits]
    shown: Shown
    connections: Mapping[str, Connection]
    desk: Desk
    has_camera: bool
    commission: Callable[[], Mapping[str, Any] | None] = lambda: None
    tracking: Callable[[float], Mapping[str, Any] | None] = lambda _now: None
    commissions: Sequence[str] = ()  # devices whose commissioning can be started from here


class StatePublisher:
    """Writes a state for each tick into the ring."""

    def __init__(self, parts: Parts, ring: RingWriter) -> None:
        self._parts, self._ring = parts, ring
        self._packer = StatePacker()
        self._seldom: Mapping[str, Any] = {}
        self._of: tuple[object, ...] = ()
        self._fixed = {axis.value: _facts(axis, of) for axis, of in parts.limits.items()}
        self._stopped_at: float | None = None
        self._recording_since: float | None = None
        self._tick = Tick(0.0, {}, {}, (), {})

    def publish(self, run: str, now: float, tick: Tick | None = None) -> None:
        """The state at `now`, in a run that is "waiting", "running", "stopping", "releasing" or "over"."""
        self._tick = tick or self._tick
        status = self._parts.shown.status
        beside = None if tick is None else (as_plain(tick), dict(status.deflections))
        data = self._packer.pack(self._often(run, now, status), self._seldom_now(status), beside)
        self._ring.write(data)
        self._parts.desk.tick = self._ring.number

    def _often(self, run: str, now: float, status: OperatorStatus) -> Mapping[str, Any]:
        parts, shown = self._parts, self._parts.shown
        control = parts.desk.control
        drivers = {**shown.drivers(), **{axis: each.name for each in status.inputs for axis in each.moves}}
        stick, age = parts.desk.stick, parts.desk.stick.age(now)
        if status.recording and self._recording_since is None:
            self._recording_since = now
        self._recording_since = self._recording_since if status.recording else None
        if status.stopped and self._stopped_at is None:
            self._stopped_at = date()
        self._stopped_at = self._stopped_at if status.stopped else None
        return {
            "tick": self._ring.number + 1,
            "time": now,
            "clock": date(),
            "run": run,
            "axes": {axis.value: self._axis(axis, now, drivers) for axis in parts.limits},
            "holder": control.name or None,
            "holder_session": control.holder.session if control.holder else None,
            "asking": control.asking.name if control.asking else None,
            "stopped": status.stopped,
            "stopped_by": shown.stopped_by,
            "stopped_at": self._stopped_at,
            "recording": status.recording,
            "recording_s": round(now - self._recording_since, 2) if self._recording_since is not None else 0.0,
            "move": shown.move(now),
            "shoot": shown.shoot(now),
            "commission": parts.commission(),
            "tracking": parts.tracking(now),
            "battery": shown.battery,
            "links": {name: self._link(connection, now) for name, connection in parts.connections.items()},
            "sticks": {
                "missed": stick.missed,
                "age_ms": None if age is None else round(age * 1000, 1),
                "armed": stick.armed,
                "waits_for": stick.waits_for,
            },
        }

    def _axis(self, axis: Axis, now: float, drivers: Mapping[Axis, str]) -> Mapping[str, Any]:
        reading, state = self._tick.reported.get(axis), self._tick.motion.get(axis)
        return {
            **self._fixed[axis.value],
            "measured": None if reading is None else round(reading.position, 4),
            "measured_age_ms": None if reading is None else round((now - reading.time) * 1000, 1),
            "commanded": None if state is None else round(state.position, 4),
            "speed": 0.0 if state is None else round(state.velocity, 4),
            "driver": drivers.get(axis, ""),
        }

    def _link(self, connection: Connection, now: float) -> Mapping[str, Any]:
        age = max(0.0, now - connection.heard)
        return {"age_ms": round(age * 1000, 1), "ok": age < QUIET}

    def _seldom_now(self, status: OperatorStatus) -> Mapping[str, Any]:
        parts, shown = self._parts, self._parts.shown
        errors = shown.errors
        of = (
            status.messages,
            status.inputs,
            status.range,
            status.follow,
            status.manual_control,
            shown.changes,
            id(errors),
        )
        if of == self._of:
            return self._seldom
        self._of = of
        self._seldom = {
            "rig": parts.rig,
            "camera": parts.has_camera,
            "commissions": list(parts.commissions),
            "keys": list(shown.keys),
            "presets": dict(list(shown.presets.items())[:PRESETS]),
            "range": status.range + 1,
            "ranges": list(status.ranges),
            "follow": status.follow,
            "focus_marks": dict(shown.focus_marks),
            "manual": status.manual_control,
            "errors": errors,
            "inputs": [
                {
                    "name": each.name,
                    "drives": [axis.value for axis in each.moves],
                    "waits_for": each.waits_for,
                    "trouble": each.trouble,
                }
                for each in status.inputs
            ],
            "messages": [{"time": at, "text": text[:LONGEST]} for at, text in status.messages[:MESSAGES]],
        }
        return self._seldom


def _facts(axis: Axis, limits: Limits) -> Mapping[str, Any]:
    """What never changes. JSON has no infinity: an axis that turns for ever has no ends."""
    return {
        "unit": axis.unit,
        "minimum": finite(limits.minimum),
        "maximum": finite(limits.maximum),
        "max_speed": limits.velocity,
        "continuous": limits.continuous,
    }
