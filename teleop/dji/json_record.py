"""A frame as one JSON object, and back, exactly.

    {"message": "gimbal.position", "reply": false, "cmd_type": 3, "sequence": 4386, "fields": {"yaw": 3.2, ...}}

What is unusual stands between `sequence` and `fields` and only when it is: `version`, `reserved` (hexadecimal) and
`encryption` (the whole byte) of the header, and `bare` for a reply of old firmware without set and id. Encrypted data
are opaque without their key; with it they are decoded, and `filling` has the bytes that had filled them up. Lengths
and checks are not written down: a frame that decodes has the right ones. Damage is {"damage": reason, "bytes":
hexadecimal}, so that a whole recording can be turned back into its bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import Any

from teleop.core.errors import UsageError
from teleop.dji.drone.encryption import Cipher
from teleop.dji.frame import Damage, Frame
from teleop.dji.message import bytes_from_json
from teleop.dji.registry import Decoded, Registry

Record = dict[str, Any]
MakeCipher = Callable[[], Cipher]  # called when something is encrypted: its library need not be there for the rest


class RecordError(UsageError):
    """A JSON object that is not a frame."""


class Transcriber:
    """Writes down the frames of one bus in order; it remembers requests, to name the replies that do not say."""

    def __init__(self, registry: Registry, cipher: MakeCipher | None = None) -> None:
        self._registry, self._cipher = registry, cipher
        self._requests: dict[Hashable, bytes] = {}  # set and id by exchange: at most 65536, and 32 times that onboard

    def record(self, found: Frame | Damage) -> Record:
        """`found` as a JSON object."""
        if isinstance(found, Damage):
            return {"damage": found.reason, "bytes": found.data.hex()}
        deciphered = self._cipher().decrypt(found) if self._cipher and found.is_encrypted else None
        plain = deciphered.frame if deciphered else found
        exchange = self._registry.exchange(found)
        request = self._requests.get(exchange, b"") if found.is_reply else b""
        decoded = self._registry.decode(plain, request)
        # Some clients never count up: what has no reply must not take the place of a question with the same number.
        if found.allows_reply and not plain.is_encrypted and decoded.message.has_reply:
            self._requests[exchange] = plain.data[:2]
        record = describe(self._registry, found, decoded)
        if deciphered:
            fields = record.pop("fields")
            record |= {"filling": deciphered.filling.hex(), "fields": fields}
        return record


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
    "filling": str,
    "fields": dict,
}
_USUAL: Record = {"version": 0, "reserved": "000000", "encryption": 0, "bare": False, "filling": None}


def restore(registry: Registry, record: object, cipher: MakeCipher | None = None) -> bytes:
    """The bytes that `record` was made from. Raises RecordError, FieldError, FrameError or CipherError."""
    if not isinstance(record, dict):
        raise RecordError("not a JSON object")
    if "damage" in record:
        return bytes_from_json("damage", "bytes", record.get("bytes"))
    _check_shape(record)
    record = _USUAL | record
    message = registry.message(record["message"], record["reply"], record["fields"])
    bare = record["bare"] or (record["reply"] and not registry.replies_have_command)
    data = (b"" if bare else registry.command(record["message"])) + message.encode()
    if record["filling"] is not None:
        data = _encrypted(data, record, cipher)
    reserved = bytes_from_json("frame", "reserved", record["reserved"])
    return Frame(
        data, record["cmd_type"], record["sequence"], record["encryption"], reserved, record["version"]
    ).encode()


def _encrypted(data: bytes, record: Record, cipher: MakeCipher | None) -> bytes:
    if cipher is None:
        raise RecordError("'filling' says that it was encrypted: give the key that it was decoded with")
    data, encryption = cipher().encrypt(data, bytes_from_json("frame", "filling", record["filling"]))
    if encryption != record["encryption"]:
        raise RecordError(f"'encryption' is {record['encryption']}, and {encryption} with this 'filling'")
    return data


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
