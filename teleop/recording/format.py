"""What a take is on disk: an MCAP file of JSON channels, each with a JSON Schema, so that Foxglove plots it as it is.

The time of a message is the wall clock at the start plus the loop's time since, so the loop's own grid can be read back
exactly. A reading has the time of its measurement, not of its arrival. What is in the channels is in `topics`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import BinaryIO

from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.recording.played import Played, SequenceFacts
from teleop.recording.topics import SCHEMAS, TopicWriter, as_json, plain

ABOUT, END = "teleop take", "teleop end"  # the names of the metadata records
FORMAT = "1"
CUT = "cut"  # the result of a run whose end is not recorded: of a file that was recovered
CHUNK = 1 << 20  # bytes of messages after which a chunk is written even without a flush
LIMITS = ("minimum", "maximum", "velocity", "acceleration", "jerk")

NO_SEQUENCE = SequenceFacts()


@dataclass(frozen=True)
class About:
    """The description at the start of a take; `started` is in s since 1970, the axes are those of `limits`."""

    rig: str
    title: str
    started: float
    limits: Mapping[Axis, Limits]
    version: str
    sequence: SequenceFacts = NO_SEQUENCE

    def record(self) -> dict[str, str]:
        """As the strings of a metadata record; a limit that there is not is null."""
        axes = {axis.value: {name: _finite(getattr(of, name)) for name in LIMITS} for axis, of in self.limits.items()}
        plain = {"format": FORMAT, "rig": self.rig, "title": self.title, "version": self.version}
        return {**plain, "started": repr(self.started), "axes": json.dumps(axes), **self.sequence.record()}


class TakeWriter:
    """Turns ticks into messages on `stream`, which needs `write`, `flush` and `tell`; raises what the stream raises."""

    def __init__(self, stream: BinaryIO, about: About) -> None:
        from mcap.writer import Writer  # with its compressors, only where something is recorded

        self._writer = Writer(stream, chunk_size=CHUNK, enable_data_crcs=True)
        self._writer.start(profile="", library=f"teleop {about.version}")
        self._writer.add_metadata(ABOUT, about.record())
        self._started = round(about.started * 1e9)
        self._origin = math.nan
        self._channels: dict[str, int] = {}
        self._topics = TopicWriter(self._write)
        self.ticks, self.seconds = 0, 0.0
        for topic, schema in SCHEMAS.items():
            known = self._writer.register_schema(f"teleop.{schema['title']}", "jsonschema", as_json(schema))
            self._channels[topic] = self._writer.register_channel(topic, "json", known)

    def add(self, tick: Tick, status: object) -> None:
        """What is new in this tick, and in the operator's status at that time."""
        if self.ticks == 0:
            self._origin = tick.time
        self.seconds = tick.time - self._origin
        self.ticks += 1
        self._topics.tick(tick)
        if isinstance(status, Played):
            self._topics.played(tick.time, status)
        elif status is not None:
            self._topics.status(tick.time, plain(status))

    def flush(self) -> None:
        """Everything so far goes to the stream; a reader of a file that is cut later will have it."""
        self._writer.flush()

    def end(
        self, result: str, reasons: Sequence[str], dropped: int, links: Mapping[str, Mapping[str, int]] | None = None
    ) -> None:
        """How the run ended, what each of its links counted, and the index."""
        self._writer.flush()
        self._writer.add_metadata(END, ending_record(result, reasons, dropped, self.ticks, self.seconds, links or {}))
        self._writer.finish()

    def _write(self, topic: str, time: float, data: bytes) -> None:
        nanoseconds = self._started + round((time - self._origin) * 1e9)
        self._writer.add_message(self._channels[topic], nanoseconds, data, nanoseconds)


def ending_record(
    result: str,
    reasons: Sequence[str],
    dropped: int,
    ticks: int,
    seconds: float,
    links: Mapping[str, Mapping[str, int]],
) -> dict[str, str]:
    """The strings of the metadata record that ends a take."""
    counts = {"dropped": str(dropped), "ticks": str(ticks), "seconds": f"{seconds:.2f}"}
    return {"result": result, "reasons": json.dumps(list(reasons)), **counts, "links": json.dumps(links)}


def _finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None
