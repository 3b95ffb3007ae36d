"""A capture as MCAP: a JSON message for each frame, with a metadata record that says where it was made.

Topic `/can` has `{"id": 546, "data": "aa1a..."}`, with `extended`, `remote` or `error` where one is true; topic
`/serial` has `{"direction": "from device", "data": "aa..."}`, as much as was read at once. Data is hexadecimal, the
time of a message that of its frame. There are no chunks, whose index would grow for as long as a capture lasts; and
what is written is whole after a kill.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import IO, TYPE_CHECKING, Any

from teleop.captures.captured import FROM_DEVICE, TO_DEVICE, Captured, CaptureError, Source

if TYPE_CHECKING:
    from mcap.records import McapRecord

MAGIC = b"\x89MCAP0\r\n"
ABOUT = "teleop capture"  # the name of the metadata record
FORMAT = "1"
_DIRECTIONS: Mapping[int, str] = {FROM_DEVICE: "from device", TO_DEVICE: "to device"}
_FLAGS = "extended", "remote", "error"
_HEX = {"type": "string", "description": "hexadecimal"}
_SCHEMAS: Mapping[str, Mapping[str, Any]] = {
    "can": {
        "title": "CAN frame",
        "type": "object",
        "properties": {"id": {"type": "integer"}, "data": _HEX, **{flag: {"type": "boolean"} for flag in _FLAGS}},
    },
    "serial": {
        "title": "Serial bytes",
        "type": "object",
        "properties": {"direction": {"enum": list(_DIRECTIONS.values())}, "data": _HEX},
    },
}


class McapWriter:
    """Writes frames to `stream`, which needs `write`, `flush` and `tell`; raises what the stream raises."""

    def __init__(self, stream: IO[bytes], source: Source, version: str) -> None:
        from mcap.writer import Writer

        self._writer = Writer(stream, use_chunking=False, enable_data_crcs=True)  # type: ignore[arg-type]
        self._writer.start(profile="", library=f"teleop {version}")
        about = {"format": FORMAT, "kind": source.kind, "interface": source.interface, "device": source.device}
        self._writer.add_metadata(ABOUT, about)
        schema = _SCHEMAS[source.kind]
        known = self._writer.register_schema(f"teleop.{schema['title']}", "jsonschema", json.dumps(schema).encode())
        self._channel = self._writer.register_channel(f"/{source.kind}", "json", known)
        self._is_can = source.kind == "can"

    def add(self, frame: Captured) -> None:
        content: dict[str, Any] = {"id": frame.id} if self._is_can else {"direction": _DIRECTIONS[frame.id]}
        content["data"] = frame.data.hex()
        content.update((flag, True) for flag in _FLAGS if getattr(frame, flag))
        time = round(frame.time * 1e6) * 1000  # a double has no finer time than that
        self._writer.add_message(self._channel, time, json.dumps(content, separators=(",", ":")).encode(), time)

    def finish(self) -> None:
        self._writer.finish()


def source(metadata: Mapping[str, str], name: str) -> Source:
    """Of the metadata record of the file called `name`. Raises CaptureError for a later format."""
    if metadata.get("format") != FORMAT or metadata.get("kind") not in _SCHEMAS:
        raise CaptureError(f"{name}: a capture of a later version of teleop: format {metadata.get('format')!r}")
    device = "drone" if metadata.get("device") == "drone" else "gimbal"
    return Source("serial" if metadata["kind"] == "serial" else "can", metadata.get("interface", ""), device)


def frame(record: McapRecord) -> Captured:
    """Of a message record. Raises ValueError, KeyError, TypeError for another's."""
    content = json.loads(record.data)  # type: ignore[attr-defined]
    senders = {direction: sender for sender, direction in _DIRECTIONS.items()}
    sender = content["id"] if "id" in content else senders[content["direction"]]
    flags = (bool(content.get(flag)) for flag in _FLAGS)
    return Captured(record.log_time // 1000 / 1e6, int(sender), bytes.fromhex(content["data"]), *flags)  # type: ignore[attr-defined]


def messages(records: Iterable[McapRecord], name: str) -> Iterable[tuple[Source, Captured]]:
    """The frames of the file called `name`, with where they were captured. Raises CaptureError."""
    from mcap.records import Message, Metadata

    about: Source | None = None
    for record in records:
        if isinstance(record, Metadata) and record.name == ABOUT:
            about = source(record.metadata, name)
        elif isinstance(record, Message):
            if about is None:
                raise CaptureError(f"{name}: an MCAP file, and no capture of teleop monitor")
            try:
                yield about, frame(record)
            except (ValueError, KeyError, TypeError) as error:
                raise CaptureError(f"{name}: damaged: {error}") from None
