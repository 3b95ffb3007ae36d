"""One pass through a take's file: its description and its messages, one at a time.

Hours of a run need too much memory at once; a caller that needs little of them reads it here. Everything is checked:
another program's MCAP, a take of a later format and a damaged chunk each have an error of their own.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis, Limits
from teleop.core.plain import plain
from teleop.recording.format import ABOUT, CUT, END, FORMAT, LIMITS, About
from teleop.recording.played import sequence_facts
from teleop.recording.records import Progress, whole_records


@dataclass(frozen=True)
class Ending:
    """Why a run stopped, how many of its ticks the recorder had to leave out, and what its links counted."""

    result: str
    reasons: Sequence[str]
    dropped: int
    links: Mapping[str, Mapping[str, int]] = field(default_factory=dict)

    def __str__(self) -> str:
        return ": ".join([self.result, "; ".join(self.reasons)]).removesuffix(": ")


class Line(NamedTuple):
    """A message: `time` in s from the first tick, its topic, and JSON."""

    time: float
    topic: str
    data: bytes


class Messages(Progress):
    """The messages of a take, once; `about` is there with the first of them, `ending` at best after the last."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self.ending: Ending | None = None
        self._about: About | None = None

    def __iter__(self) -> Iterator[Line]:
        """Raises DocumentError when the file cannot be read at all, or is not a take."""
        from mcap.records import Channel, Message, Metadata

        topics: dict[int, str] = {}
        started = 0
        with reading_errors(self.path):
            for record in whole_records(self.path, self):
                if isinstance(record, Message):
                    if self._about is None:
                        raise ValueError("its first record does not describe the take")
                    yield Line((record.log_time - started) / 1e9, topics[record.channel_id], record.data)
                elif isinstance(record, Channel):
                    topics[record.id] = record.topic
                elif isinstance(record, Metadata) and record.name == ABOUT:
                    self._about = about(record.metadata)
                    started = round(self._about.started * 1e9)
                elif isinstance(record, Metadata) and record.name == END:
                    self.ending = ending(record.metadata)

    @property
    def about(self) -> About:
        """The take's description; raises DocumentError when the file was read and has none."""
        if self._about is None:
            raise DocumentError([f"{self.path}: not a take of this program"])
        return self._about

    @property
    def lost(self) -> int:
        """Bytes at the end that could not be read."""
        return self.size - self.whole

    @property
    def remark(self) -> str:
        """A line for the user about a file that is not whole, "" about one that is; known after the last message."""
        if self.closed and self.ending is not None:
            return ""
        cure = f"To repair: teleop take recover {self.path}"
        return f"{self.path}: the recording was cut off; only the whole part is read. {cure}"


@contextmanager
def reading_errors(path: Path) -> Iterator[None]:
    """Turn the errors of reading a file that is no take into a DocumentError."""
    try:
        yield
    except OSError as error:
        raise DocumentError([f"{path}: cannot be read: {error.strerror or error}"]) from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise DocumentError([f"{path}: not a take of this program: {error}"]) from None


def about(metadata: Mapping[str, str]) -> About:
    """The first metadata record; raises ValueError, KeyError and TypeError for another's."""
    if metadata.get("format") != FORMAT:
        raise ValueError(f"it has format {metadata.get('format')!r}, this program reads {FORMAT!r}")
    limits = {}
    for name, of_axis in json.loads(metadata["axes"]).items():
        low, high, *magnitudes = (of_axis[name] for name in LIMITS)
        low, high = (-math.inf if low is None else low), (math.inf if high is None else high)
        limits[Axis(name)] = Limits(low, high, *magnitudes)
    played = sequence_facts(metadata)
    return About(
        plain(metadata["rig"]),
        plain(metadata["title"]),
        float(metadata["started"]),
        limits,
        metadata["version"],
        played,
    )


def ending(metadata: Mapping[str, str]) -> Ending:
    """The last metadata record; raises as `about`."""
    links = json.loads(metadata.get("links", "{}"))
    return Ending(metadata["result"], json.loads(metadata["reasons"]), int(metadata["dropped"]), links)


def was_cut(ended: Ending | None) -> bool:
    """Whether the run went on after what is recorded, so that its end is unknown."""
    return ended is None or ended.result == CUT
