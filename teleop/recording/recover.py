"""A take that was never closed, or is damaged, copied into a new file that is sound.

What is whole is copied message by message, unchanged; the new end says that the run's end is unknown. The original is
only read.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from teleop.config.documents.document import DocumentError
from teleop.recording.format import ABOUT, CUT, END, ending_record
from teleop.recording.messages import Messages, about, reading_errors
from teleop.recording.records import Progress, whole_records

if TYPE_CHECKING:
    from mcap.records import McapRecord, Message
    from mcap.writer import Writer


@dataclass
class Saved:
    """What could be copied: `seconds` from the first to the last of `ticks`; `lost` bytes could not be read."""

    messages: int = 0
    ticks: int = 0
    seconds: float = 0.0
    lost: int = 0
    size: int = 0


def is_sound(path: Path) -> bool:
    """Whether a file has all that a closed take has; raises DocumentError when it is no take at all."""
    messages = Messages(path)
    for _ in messages:
        pass
    _ = messages.about
    return not messages.remark


def recover(path: Path, stream: BinaryIO) -> Saved:
    """Copy what is whole of the take at `path` to `stream`, which needs `write`, `flush` and `tell`.

    Raises DocumentError when nothing is there to be saved, and what the stream raises.
    """
    from mcap.writer import Writer

    saved, progress = Saved(), Progress()
    copy = _Copy(Writer(stream, enable_data_crcs=True), saved)
    records = whole_records(path, progress)
    while True:
        with reading_errors(path):
            record = next(records, None)
        if record is None:
            break
        copy.add(path, record)
    saved.lost, saved.size = progress.size - progress.whole, progress.size
    if saved.messages == 0:
        raise DocumentError([f"{path}: nothing to recover: it was cut off before its first second was written"])
    copy.end(path)
    return saved


class _Copy:
    """The records of one take as they come, written again; channels and schemas keep their names and get new ids."""

    def __init__(self, writer: Writer, saved: Saved) -> None:
        self._writer, self._saved = writer, saved
        self._schemas: dict[int, int] = {}
        self._channels: dict[int, int] = {}
        self._motion = 0  # the id of the channel whose messages are ticks
        self._started: int | None = None
        self._ended = False

    def add(self, path: Path, record: McapRecord) -> None:
        from mcap.records import Channel, Message, Metadata, Schema

        if isinstance(record, Metadata):
            with reading_errors(path):
                self._metadata(record.name, record.metadata)
        elif isinstance(record, Schema) and record.id not in self._schemas:
            self._schemas[record.id] = self._writer.register_schema(record.name, record.encoding, record.data)
        elif isinstance(record, Channel) and record.id not in self._channels:
            schema = self._schemas.get(record.schema_id, 0)
            new = self._writer.register_channel(record.topic, record.message_encoding, schema, record.metadata)
            self._channels[record.id] = new
            if record.topic == "/motion":
                self._motion = record.id
        elif isinstance(record, Message):
            if self._started is None or record.channel_id not in self._channels:
                raise DocumentError([f"{path}: not a take of this program"])
            self._message(record)

    def end(self, path: Path) -> None:
        """How the run ended, where the file says it, and the index."""
        if not self._ended:
            why = [f"recovered from {path.name}, which was not closed"]
            self._writer.add_metadata(END, ending_record(CUT, why, 0, self._saved.ticks, self._saved.seconds, {}))
        self._writer.finish()

    def _metadata(self, name: str, metadata: dict[str, str]) -> None:
        if name == ABOUT:
            self._started = round(about(metadata).started * 1e9)
            self._writer.start(profile="", library=f"teleop {metadata['version']}")
        if self._started is not None:
            self._writer.flush()
            self._writer.add_metadata(name, metadata)
        self._ended = self._ended or name == END

    def _message(self, record: Message) -> None:
        self._saved.messages += 1
        if record.channel_id == self._motion:
            self._saved.ticks += 1
            self._saved.seconds = (record.log_time - (self._started or 0)) / 1e9
        channel = self._channels[record.channel_id]
        self._writer.add_message(channel, record.log_time, record.data, record.publish_time, record.sequence)
