"""A MIDI controller's section, the state that it is shown, and the limits of its rig, for tests and the hunt."""

from __future__ import annotations

from typing import Any

from teleop.config.exchange.midi import MidiSection
from teleop.core.axes import Axis, Limits

LIMITS = {
    Axis.PAN: Limits(-90.0, 90.0, 60.0, 240.0, 2400.0),
    Axis.TILT: Limits(-50.0, 50.0, 60.0, 240.0, 2400.0),
    Axis.FOCUS: Limits(0.0, 1.0, 1.0, 4.0, 40.0),
}
CONTROLS = [
    {"sends": "note 1", "press": "stop"},
    {"sends": "note 2", "press": "record"},
    {"sends": "cc 20", "press": "play reveal"},
    {"sends": "note 3", "press": "range 2"},
    {"sends": "cc 7", "position": "pan"},
    {"sends": "cc14 1", "position": "focus"},
    {"sends": "bend ch 2", "position": "tilt"},
    {"sends": "bend", "speed": "pan"},
    {"sends": "cc 60", "jog": "tilt", "step": 0.25},
]
OWN = "midi-1"


def section(controls: list[dict[str, Any]] = CONTROLS, **fields: Any) -> MidiSection:
    return MidiSection.model_validate({"type": "midi", "port": "desk", "controls": controls, **fields})


def state(pan: float = 0.0, tilt: float = 0.0, focus: float = 0.0, **fields: Any) -> dict[str, Any]:
    places = {"pan": pan, "tilt": tilt, "focus": focus}
    axes = {axis: {"commanded": to, "measured": to, "speed": 0.0} for axis, to in places.items()}
    plain = {"stopped": False, "recording": False, "move": None, "holder_session": None, "range": 1, "age_ms": 5.0}
    return {"axes": axes, **plain, **fields}
