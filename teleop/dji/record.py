"""A frame as one JSON object, and back, exactly.

    {"message": "gimbal.position", "reply": false, "cmd_type": 3, "sequence": 4386, "fields": {"yaw": 3.2, ...}}

What is unusual stands between `sequence` and `fields` and only when it is: `version`, `reserved` (hexadecimal) and
`encryption` (the whole byte; the data is then opaque) of the header, and `bare` for a reply of old firmware without
set and id. Lengths and checks are not written down: a frame that decodes has the right ones. Damage is
{"damage": reason, "bytes": hexadecimal}, so that a whole recording can be turned back into its bytes.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

from teleop.dji.frame import Damage, Frame
from teleop.dji.message import bytes_from_json
from teleop.dji.registry import Decoded, Registry
from teleop.ports import UsageError

Record = dict[str, Any]


class RecordError(UsageError):
    """A JSON object that is not a frame."""


class Transcriber:
    """Writes down the frames of one bus in order; it remembers requests, to name the replies that do not say."""

    def __init__(self, registry: Registry) -> None:
        self._registry = registry
        self._requests: dict[Hashable, bytes] = {}  # set and id by exchange: at most 65536, and 32 times that onboard

    def record(self, found: Frame | Damage) -> Record:
        """`found` as a JSON object."""
        if isinstance(found, Damage):
            return {"damage": found.reason, "bytes": found.data.hex()}
        exchange = self._registry.exchange(found)
        if found.allows_reply and not found.is_encrypted:
            self._requests[exchange] = found.data[:2]
        request = self._requests.get(exchange, b"") if found.is_reply else b""
        return describe(self._registry, found, self._registry.decode(found, request))


def describe(registry: Registry, frame: Frame, decoded: Decoded) -> Record:
    """`frame`, which `registry` decoded, as a JSON object."""
    unusual = {
        "version": frame.version,
        "reserved": frame.reserved.hex() if any(frame.reserved) else "",
        "encryption": frame.encryption,
        "bare": decoded.bare,
    }
    return {
        "message": registry.name(decoded),
        "reply": frame.is_reply,
        "cmd_type": frame.cmd_type,
        "sequence": frame.sequence,
        **{key: value for key, value in unusual.items() if value},
        "fields": decoded.message.fields(),
    }


_TYPES: Mapping[str, type] = {
    "message": str,
    "reply": bool,
    "cmd_type": int,
    "sequence": int,
    "version": int,
    "reserved": str,
    "encryption": int,
    "bare": bool,
    "fields": dict,
}
_USUAL: Record = {"version": 0, "reserved": "000000", "encryption": 0, "bare": False}


def restore(registry: Registry, record: object) -> bytes:
    """The bytes that `record` was made from. Raises RecordError, FieldError or FrameError."""
    if not isinstance(record, dict):
        raise RecordError("not a JSON object")
    if "damage" in record:
        return bytes_from_json("damage", "bytes", record.get("bytes"))
    _check_shape(record)
    record = _USUAL | record
    message = registry.message(record["message"], record["reply"], record["fields"])
    bare = record["bare"] or (record["reply"] and not registry.replies_have_command)
    return Frame(
        (b"" if bare else registry.command(record["message"])) + message.encode(),
        record["cmd_type"],
        record["sequence"],
        record["encryption"],
        bytes_from_json("frame", "reserved", record["reserved"]),
        record["version"],
    ).encode()


def _check_shape(record: Record) -> None:
    for key, kind in _TYPES.items():
        if key not in record and key not in _USUAL:
            raise RecordError(f"{key!r} is missing")
        if key in record and type(record[key]) is not kind:
            raise RecordError(f"{key!r} must be of type {kind.__name__}, not {record[key]!r}")
    unknown = record.keys() - _TYPES.keys()
    if unknown:
        raise RecordError(f"unknown {', '.join(map(repr, sorted(unknown)))}; there are {', '.join(_TYPES)}")
    if record["reply"] != bool(record["cmd_type"] & 0x20):
        raise RecordError(f"'reply' is {record['reply']}, which 'cmd_type' {record['cmd_type']} contradicts")
