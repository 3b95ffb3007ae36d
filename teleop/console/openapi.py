"""The HTTP interface described for programs: OpenAPI 3.1, served at `/api`. The reference page has it in words."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import teleop
from teleop.console.command_schemas import command_schema, command_schemas

ERRORS = {
    "400": "Malformed or unknown",
    "401": "No login, or a wrong token",
    "403": "Another site's page, or a role that only watches",
    "404": "No such name",
    "409": "Another holds control, has changed the file, or turned the page",
    "413": "Too large",
    "422": "What the rig cannot do, or a move that cannot be planned",
    "429": "Too many requests",
    "503": "The rig does not answer",
}
OBJECT: Mapping[str, Any] = {"type": "object"}
ERROR = {
    "type": "object",
    "properties": {
        "error": {"type": "string"},
        "kind": {"type": "string"},
        "holder": {"type": ["string", "null"], "description": "who has control"},
    },
    "required": ["error"],
}
STATE = {
    "type": "object",
    "properties": {
        "rig": {"type": "string"},
        "age_ms": {"type": "number", "description": "since the state was made"},
        "axes": {"type": "object", "additionalProperties": {"$ref": "#/components/schemas/Axis"}},
        "holder": {"type": ["string", "null"], "description": "who has control"},
        "stopped": {"type": "boolean"},
        "recording": {"type": "boolean"},
        "move": {"type": ["object", "null"]},
    },
    "required": ["axes", "holder", "stopped", "recording", "move", "age_ms"],
}
AXIS = {
    "type": "object",
    "properties": {
        "measured": {"type": ["number", "null"], "description": "null before the first reading"},
        "measured_age_ms": {"type": ["number", "null"]},
        "commanded": {"type": "number"},
        "unit": {"type": "string", "description": "deg, or empty for 0 to 1"},
        "minimum": {"type": ["number", "null"]},
        "maximum": {"type": ["number", "null"]},
    },
    "required": ["measured", "commanded"],
}
TEXT = {"type": "string"}
MOVE_BODY = {
    "type": "object",
    "properties": {"content": OBJECT, "text": TEXT, "version": TEXT},
    "description": "the values of the move, or its whole YAML text",
}
PLAN_BODY = {"type": "object", "properties": {"move": TEXT, "content": OBJECT, "text": TEXT, "name": TEXT}}
KEYS_BODY = {
    "type": "object",
    "properties": {"tolerance": {"type": "number", "exclusiveMinimum": 0, "maximum": 45}, "save": TEXT},
}
LOGIN_BODY = {"type": "object", "properties": {"token": TEXT}, "required": ["token"]}


@cache
def description() -> dict[str, Any]:
    """The description of everything under `/api`."""
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "teleop console",
            "version": teleop.__version__,
            "description": "State and commands of a rig. The WebSocket at /ws is on the reference page of the docs.",
            "license": {"name": "MIT", "identifier": "MIT"},
        },
        "servers": [{"url": "/"}],
        "security": [{"token": []}, {"cookie": []}, {}],
        "paths": _paths(),
        "components": {
            "securitySchemes": {
                "token": {"type": "http", "scheme": "bearer"},
                "cookie": {"type": "apiKey", "in": "cookie", "name": "teleop_PORT"},
            },
            "schemas": {"Error": ERROR, "State": STATE, "Axis": AXIS, "Command": command_schema(), **command_schemas()},
            "responses": {
                f"E{status}": {"description": text, "content": _json({"$ref": "#/components/schemas/Error"})}
                for status, text in ERRORS.items()
            },
        },
    }


def _paths() -> dict[str, Any]:
    command = {"$ref": "#/components/schemas/Command"}
    return {
        "/api": {"get": _operation("describe", "This description")},
        "/api/state": {"get": _operation("state", "The newest state", {"$ref": "#/components/schemas/State"})},
        "/api/command": {"post": _operation("command", "Give a command", body=command)},
        "/api/stop": {"post": _operation("stop", "STOP, for every role; sent until the state shows it")},
        "/api/fleet": {"get": _operation("fleet", "The rigs of this rig's fleet")},
        "/api/fleet/stop": {
            "post": _operation("fleet_stop", "STOP for all rigs, for every role; names those not reached")
        },
        "/api/login": {"post": {**_operation("login", "A token for a cookie", body=LOGIN_BODY), "security": [{}]}},
        "/api/moves": {"get": _operation("moves", "The moves that there are")},
        "/api/moves/{name}": {
            "parameters": [_NAME],
            "get": _operation("move", "A move: its text and its values"),
            "put": _operation("save", "Save a move; comments are kept", body=MOVE_BODY),
        },
        "/api/plan": {"post": _operation("plan", "Plan a move", body=PLAN_BODY)},
        "/api/takes": {"get": _operation("takes", "The takes that there are")},
        "/api/takes/{name}": {"parameters": [_NAME], "get": _operation("take", "A take and its errors")},
        "/api/takes/{name}/keys": {
            "parameters": [_NAME],
            "post": _operation("keys", "Keyframes fitted to a take", body=KEYS_BODY),
        },
    }


_NAME = {"name": "name", "in": "path", "required": True, "schema": TEXT, "description": "a name, never a path"}


def _operation(
    name: str, summary: str, answer: Mapping[str, Any] = OBJECT, body: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    answers = {status: {"$ref": f"#/components/responses/E{status}"} for status in ERRORS}
    operation: dict[str, Any] = {
        "operationId": name,
        "summary": summary,
        "responses": {"200": {"description": "Done, or accepted", "content": _json(answer)}, **answers},
    }
    if body is not None:
        operation["requestBody"] = {"required": True, "content": _json(body)}
    return operation


def _json(schema: Mapping[str, Any]) -> dict[str, Any]:
    return {"application/json": {"schema": schema}}
