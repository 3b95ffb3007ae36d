"""Commands and answers as they pass the door: msgpack maps with bounds, checked in full before anything sees them.

A command is `{"id", "session", "person", "time", "do", ...}`, an answer `{"id", "ok" or "error", ...}`. What is
unknown, malformed or too large is a `CommandError`, which has the reason and whatever of the id could be read.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import msgpack

from teleop.door.fields import Check, axes, axis, number, plain_fields, text, truth, whole
from teleop.door.sockets import LARGEST

FAR = 1e6  # of a position, in units: the rig's own limits are checked where they are known
LONGEST = 3600.0  # s that one way may take
SLOWEST = 1e-6  # unit/s that a way may be limited to
MOST_SEEN = 24  # sessions in one word about who is there
MOST_ID = 2**53  # what JavaScript counts up to
SESSION, NAME = text(40, r"[\w.:-]+"), text(40)
FILE_NAME = r"[\w][\w. -]*"  # of a move: no separator, and nothing that begins with a point
MOVE_NAME = re.compile(rf"(?=.{{1,120}}$){FILE_NAME}")


class CommandError(ValueError):
    """Why a message is no command. `id` is the one it has, None where it has none."""

    def __init__(self, reason: str, number: int | None = None) -> None:
        super().__init__(reason)
        self.id = number


class Shape(NamedTuple):
    """The fields of a kind of command. Who may give it is the desk's to decide."""

    required: Mapping[str, Check] = {}
    optional: Mapping[str, Check] = {}


def _ages(value: Any) -> dict[str, float]:
    """How long ago each session was heard, in ms."""
    if not isinstance(value, Mapping) or len(value) > MOST_SEEN:
        raise ValueError(f"must be the ages of at most {MOST_SEEN} sessions")
    age = number(0.0, 1e12)
    return {SESSION(key): age(each) for key, each in value.items()}


PRESET = whole(0, 999)
NUMBER = whole(1, 999)
MARK = text(1, "[ABC]")
SOURCE = whole(1, 16)
SECONDS = number(0.0, LONGEST)
SHAPES: Mapping[str, Shape] = {
    "take_control": Shape(optional={"ask": truth}),
    "release_control": Shape(),
    "deny_control": Shape(),
    "stop": Shape(),
    "clear": Shape(),
    "stick": Shape({"seq": whole(0, MOST_ID), "axes": axes(-1.0, 1.0)}, {"hold": truth}),
    "jog": Shape({"axis": axis, "by": number(-90.0, 90.0)}, {"within": number(0.0, 60.0)}),
    "goto": Shape({"axes": axes(-FAR, FAR)}, {"seconds": SECONDS, "speeds": axes(SLOWEST, FAR)}),
    "go_motion": Shape(
        {
            "axes": axes(-FAR, FAR),
            "before": axes(-FAR, FAR),
            "after": axes(-FAR, FAR),
            "exposure": number(0.001, LONGEST),
            "blur": number(0.0, 1.0),
        }
    ),
    "preset_recall": Shape({"number": PRESET}, {"seconds": SECONDS, "stretch": truth}),
    "preset_store": Shape({"number": PRESET}, {"name": text(60)}),
    "preset_delete": Shape({"number": PRESET}),
    "set_key": Shape(),
    "delete_key": Shape({"number": NUMBER}),
    "clear_keys": Shape(),
    "play": Shape(
        {"move": text(120, FILE_NAME)},
        {
            "attended": truth,
            "passes": whole(1, 9999),
            "loop": truth,
            "speed": number(0.01, 2.0),
            "preroll": number(0.0, 600.0),
            "chase": truth,
            "sent": whole(1, MOST_ID),
            "held": truth,
        },
    ),
    "chase": Shape({"at": number(-FAR, FAR)}, {"rate": number(0.9, 1.1), "free": truth}),
    "start": Shape({"at": number(0.0, 1e12)}),
    "pause": Shape(),
    "resume": Shape(),
    "speed": Shape({"share": number(0.01, 2.0)}),
    "seek": Shape({"at": number(-LONGEST, 1e6)}),
    "next_key": Shape(),
    "previous_key": Shape(),
    "to_start": Shape(),
    "abort": Shape(),
    "record": Shape(),
    "stop_recording": Shape(),
    "shutter": Shape(),
    "recenter": Shape(optional={"seconds": SECONDS}),
    "follow": Shape({"mode": text(24, r"[a-z][a-z0-9-]*")}),
    "focus": Shape({"to": number(0.0, 1.0)}, {"seconds": SECONDS, "stretch": truth}),
    "focus_mark_store": Shape({"name": MARK}),
    "focus_mark_recall": Shape({"name": MARK}, {"seconds": SECONDS, "stretch": truth}),
    "focus_mark_delete": Shape({"name": MARK}),
    "range": Shape({"number": NUMBER}),
    "manual": Shape({"on": truth}),
    "drone": Shape({"command": text(24, r"[a-z][a-z-]*")}),
    "mark_target": Shape({"text": text(40)}),
    "shoot": Shape({"move": text(120, FILE_NAME)}, {"resume": truth, "restart": truth}),
    "commission": Shape({"device": text(8)}),
    "commission_key": Shape({"page": whole(1, MOST_ID), "key": text(12)}, {"text": text(40), "agrees": truth}),
    "track": Shape(optional={"source": SOURCE, "attended": truth}),
    "message": Shape({"name": text(60, r"[a-z][a-z0-9 _-]*")}, {"fields": plain_fields}),
    "alive": Shape(optional={"seen": _ages}),
    "closed": Shape(),
    "aim": Shape({"source": SOURCE, "axes": axes(-FAR, FAR)}),
}
"""Every command by its name. `sent` of a play is the number of a move that came as text; `held` has it planned and
kept until `start` names a moment of the rig's own clock. `alive`, `closed` and `aim` are for the gateway itself: who is
there, who has left, and where the camera would look at what a tracker reports."""

INTERNAL = ("alive", "closed", "aim")
_ENVELOPE: Mapping[str, Check] = {
    "do": text(24),
    "id": whole(0, MOST_ID),
    "session": SESSION,
    "person": NAME,
    "time": number(-1e15, 1e15),
    "brief": truth,
}


@dataclass(frozen=True, slots=True)
class DoorCommand:
    """A checked command. `time` is the sender's in ms. `brief`: it takes control for what it does alone."""

    do: str
    id: int
    session: str
    name: str
    time: float
    fields: Mapping[str, Any] = field(default_factory=dict)
    brief: bool = False


def checked(message: object) -> DoorCommand:
    """The command that a map is. Raises CommandError."""
    if not isinstance(message, Mapping):
        raise CommandError("a command must be a map")
    number = message.get("id")
    known = number if isinstance(number, int) and not isinstance(number, bool) and 0 <= number <= MOST_ID else None
    do = message.get("do")
    if not isinstance(do, str) or (shape := SHAPES.get(do)) is None:
        raise CommandError(f"do: unknown command {str(do)[:40]!r}", known)
    values: dict[str, Any] = {}
    checks = {**shape.required, **shape.optional, **_ENVELOPE}
    for key, value in message.items():
        check = checks.get(key) if isinstance(key, str) else None
        if check is None:
            raise CommandError(f"{do}: unknown field {str(key)[:40]!r}", known)
        try:
            values[key] = check(value)
        except ValueError as error:
            raise CommandError(f"{do}: {key} {error}", known) from None
    if missing := [key for key in (*shape.required, "id", "session") if key not in values]:
        raise CommandError(f"{do}: needs {', '.join(missing)}", known)
    fields = {key: value for key, value in values.items() if key not in _ENVELOPE}
    session = values["session"]
    return DoorCommand(
        *(do, values["id"], session, values.get("person", session), values.get("time", 0.0), fields),
        values.get("brief", False),
    )


def packed(message: Mapping[str, Any]) -> bytes:
    """A command or an answer as a datagram. Raises CommandError for one that is too large or has other things in it."""
    try:
        data = bytes(msgpack.packb(message) or b"")
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        raise CommandError(f"cannot be sent: {error}") from None
    if len(data) > LARGEST:
        raise CommandError(f"is too large: {len(data)} bytes, and may have {LARGEST}")
    return data


def unpacked(data: bytes) -> object:
    """What a datagram says. Raises CommandError for one that is no msgpack within its bounds."""
    if len(data) > LARGEST:
        raise CommandError(f"is too large: it may have {LARGEST} bytes")
    try:
        return msgpack.unpackb(
            data, max_str_len=256, max_bin_len=0, max_array_len=0, max_map_len=32, max_ext_len=0, strict_map_key=True
        )
    except (ValueError, TypeError, RecursionError, msgpack.exceptions.UnpackException):
        raise CommandError("is no msgpack map within its bounds") from None
