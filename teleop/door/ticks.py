"""A tick as it passes the door beside the state: every number whole, for what is sent on and recorded elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from teleop.core.axes import Axis, Reading, State
from teleop.core.events import Action, DeviceCommand, DialInput, Exposure, ShutterStep, Tick, TickEvent
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, Stop, VelocityTarget

_SETPOINTS: tuple[type[Setpoint], ...] = (VelocityTarget, PositionTarget, StateTarget, Stop)
_WISHES = {each: number for number, each in enumerate(_SETPOINTS)}


def as_plain(tick: Tick) -> Sequence[Any]:
    """For msgpack: tuples and numbers."""
    return (
        tick.time,
        dict(tick.motion),
        {axis: (_WISHES[type(setpoint)], *setpoint) for axis, setpoint in tick.demand.items()},
        [_event(event) for event in tick.actions],
        dict(tick.reported),
    )


def from_plain(plain: Sequence[Any]) -> Tick:
    """The tick that `as_plain` was given."""
    time, motion, demand, actions, reported = plain
    return Tick(
        time,
        {Axis(name): State(*state) for name, state in motion.items()},
        {Axis(name): _SETPOINTS[wish](*numbers) for name, (wish, *numbers) in demand.items()},
        [_EVENTS[kind](fields) for kind, fields in actions],
        {Axis(name): Reading(*reading) for name, reading in reported.items()},
    )


def _event(event: TickEvent) -> Sequence[Any]:
    match event:
        case Action():
            return "action", event.value
        case DeviceCommand():
            return "command", event
        case DialInput():
            return "dial", event
        case Exposure():
            return "exposure", (event.frame, event.step.value)


_EVENTS: Mapping[str, Any] = {
    "action": Action,
    "command": lambda fields: DeviceCommand(fields[0], fields[1], tuple(fields[2])),
    "dial": lambda fields: DialInput(*fields),
    "exposure": lambda fields: Exposure(fields[0], ShutterStep(fields[1])),
}
