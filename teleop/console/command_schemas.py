"""The commands as JSON Schema, for the description of the HTTP interface. The door checks them; this only describes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

Schema = Mapping[str, Any]

TEXT: Schema = {"type": "string"}
TRUTH: Schema = {"type": "boolean"}
STRETCH: Schema = {"type": "boolean", "description": "takes longer than `seconds` where the limits need it"}
NUMBER: Schema = {"type": "number"}
WHOLE: Schema = {"type": "integer", "minimum": 1}
PRESET: Schema = {"type": "integer", "minimum": 0, "maximum": 999}
SECONDS: Schema = {"type": "number", "minimum": 0, "description": "s; as soon as the limits allow without it"}
AXIS: Schema = {"type": "string", "examples": ["pan", "tilt", "roll", "focus"]}
SHARE: Schema = {"type": "number", "minimum": 0, "maximum": 1}
POSITIONS: Schema = {
    "type": "object",
    "additionalProperties": {"type": "number"},
    "description": "by axis: degrees, of focus 0 (near) to 1 (far)",
}
MARK: Schema = {"enum": ["A", "B", "C"]}
MOVE: Schema = {"type": "string", "description": "the name of a move; never a path"}


class CommandSchema(NamedTuple):
    """What a command does, and its fields."""

    summary: str
    required: Mapping[str, Schema] = {}
    optional: Mapping[str, Schema] = {}


SHARE = {"type": "number", "minimum": 0, "maximum": 1}
STICK = {
    "seq": {"type": "integer", "minimum": 0},
    "axes": {"type": "object", "additionalProperties": {"type": "number", "minimum": -1, "maximum": 1}},
}
PLAYED = {
    "attended": {"type": "boolean", "description": "false: goes on without this client"},
    "passes": WHOLE,
    "loop": TRUTH,
    "speed": {"type": "number", "description": "share of the written speed"},
    "preroll": SECONDS,
    "chase": {"type": "boolean", "description": "true: wait for the clock of `chase`, and follow it"},
    "held": {"type": "boolean", "description": "only planned, and kept until `start`"},
    "sent": {"type": "integer", "minimum": 1, "description": "of a move that came by Zenoh"},
}
SHOT = {
    "resume": {"type": "boolean", "description": "true: go on with the shoot that its journal knows"},
    "restart": {"type": "boolean", "description": "true: begin anew, whatever the journal says"},
}
COMMANDS: Mapping[str, CommandSchema] = {
    "take_control": CommandSchema("Take control; `ask` where another holds it", {}, {"ask": TRUTH}),
    "release_control": CommandSchema("Give control up"),
    "deny_control": CommandSchema("Keep control when another asks for it"),
    "stop": CommandSchema("STOP: every axis to rest, latched"),
    "clear": CommandSchema("Clear a STOP"),
    "stick": CommandSchema("One message of a stream, 50 a second", STICK, {"hold": TRUTH}),
    "jog": CommandSchema("Move an axis by so many units", {"axis": AXIS, "by": NUMBER}, {"within": SECONDS}),
    "goto": CommandSchema("Go to positions", {"axes": POSITIONS}, {"seconds": SECONDS, "speeds": POSITIONS}),
    "go_motion": CommandSchema(
        "Move through one exposure, from where its run begins",
        {"axes": POSITIONS, "before": POSITIONS, "after": POSITIONS, "exposure": SECONDS, "blur": SHARE},
    ),
    "preset_recall": CommandSchema("Go to a preset", {"number": PRESET}, {"seconds": SECONDS, "stretch": STRETCH}),
    "preset_store": CommandSchema("Keep the positions as a preset", {"number": PRESET}, {"name": TEXT}),
    "preset_delete": CommandSchema("Delete a preset", {"number": PRESET}),
    "set_key": CommandSchema("Add the positions to the keys"),
    "delete_key": CommandSchema("Delete a key", {"number": WHOLE}),
    "clear_keys": CommandSchema("Delete all keys"),
    "play": CommandSchema("Play a move; `keys` are those set by hand", {"move": MOVE}, PLAYED),
    "chase": CommandSchema(
        "Where the clock is, at `time` of this computer (ms), that a move played with `chase` follows",
        {"at": {"type": "number", "description": "s of the move"}},
        {"rate": {"type": "number", "minimum": 0.9, "maximum": 1.1}, "free": TRUTH},
    ),
    "start": CommandSchema("Begin the held move", {"at": {"type": "number", "description": "s, `time` of the state"}}),
    "pause": CommandSchema("Pause the move"),
    "resume": CommandSchema("Go on with the move"),
    "speed": CommandSchema("Change the speed of the move", {"share": NUMBER}),
    "seek": CommandSchema("Go to a time of the paused move", {"at": {"type": "number", "description": "s"}}),
    "next_key": CommandSchema("Go to the next key of the paused move"),
    "previous_key": CommandSchema("Go to the previous key of the paused move"),
    "to_start": CommandSchema("Go to the start of the paused move"),
    "abort": CommandSchema("End the move, or the way to a place"),
    "record": CommandSchema("Start recording on the camera"),
    "stop_recording": CommandSchema("Stop recording on the camera"),
    "shutter": CommandSchema("Take a picture"),
    "recenter": CommandSchema("Go to the center", {}, {"seconds": SECONDS}),
    "follow": CommandSchema("Set the follow mode of the gimbal", {"mode": TEXT}),
    "focus": CommandSchema(
        "Move the focus",
        {"to": {"type": "number", "minimum": 0, "maximum": 1}},
        {"seconds": SECONDS, "stretch": STRETCH},
    ),
    "focus_mark_store": CommandSchema("Keep the focus as a mark", {"name": MARK}),
    "focus_mark_recall": CommandSchema(
        "Move the focus to a mark", {"name": MARK}, {"seconds": SECONDS, "stretch": STRETCH}
    ),
    "focus_mark_delete": CommandSchema("Delete a mark of the focus", {"name": MARK}),
    "track": CommandSchema(
        "Follow a tracking source of the profile's exchange until it ends, STOP or abort",
        {},
        {
            "source": {**WHOLE, "description": "its number among the entries that listen; 1 without"},
            "attended": {"type": "boolean", "description": "false: goes on without this client"},
        },
    ),
    "range": CommandSchema("Choose the speed range of sticks", {"number": WHOLE}),
    "manual": CommandSchema("Turn manual control on or off, of inputs without an enable button", {"on": TRUTH}),
    "drone": CommandSchema("Have the drone do something, as `drone WORD` in a file", {"command": TEXT}),
    "mark_target": CommandSchema("Mark a target in view: `name,distance` or `name,x,y,z` (m)", {"text": TEXT}),
    "shoot": CommandSchema("Shoot a timelapse", {"move": MOVE}, SHOT),
    "commission": CommandSchema(
        "End the run, and commission a device of the rig", {"device": {"type": "string", "enum": ["gimbal", "drone"]}}
    ),
    "commission_key": CommandSchema(
        "Press a key of the page of a commissioning, by the page's number",
        {"page": WHOLE, "key": TEXT},
        {"text": TEXT, "agrees": {"type": "boolean", "description": "to what the page says of more than 5 deg/s"}},
    ),
    "message": CommandSchema("Send a message of the R SDK", {"name": TEXT}, {"fields": {"type": "object"}}),
    "plan": CommandSchema(
        "Plan a move; answered by the gateway",
        {},
        {"move": MOVE, "text": TEXT, "content": {"type": "object"}, "name": TEXT},
    ),
}
"""Every command that a client may give."""

COMMON: Mapping[str, Schema] = {
    "wait": {"type": "boolean", "description": "answer once it is done, not once it is accepted"},
    "time": {"type": "number", "description": "the sender's own clock, ms"},
}


def command_schema() -> dict[str, Any]:
    """Any command: one of all, chosen by `do`."""
    return {
        "oneOf": [{"$ref": f"#/components/schemas/{name}"} for name in COMMANDS],
        "discriminator": {
            "propertyName": "do",
            "mapping": {name: f"#/components/schemas/{name}" for name in COMMANDS},
        },
    }


def command_schemas() -> dict[str, dict[str, Any]]:
    """A schema for each command, by its name."""
    return {
        name: {
            "type": "object",
            "description": command.summary,
            "properties": {"do": {"const": name}, **command.required, **command.optional, **COMMON},
            "required": ["do", *command.required],
            "additionalProperties": False,
        }
        for name, command in COMMANDS.items()
    }
