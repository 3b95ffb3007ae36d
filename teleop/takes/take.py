"""A take read back from its file, whole or cut.

A process that was killed leaves no index and half a chunk, so every file is read as a stream, to the last record that
is whole; what a complete file has more than a cut one is only its end. Nothing is believed that is not checked: a
stranger's MCAP, a take of a later format and a damaged chunk each have their sentence.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from struct import error as StructError  # noqa: N812 - it is an error
from typing import TYPE_CHECKING, Any

import numpy as np

from teleop.document import DocumentError
from teleop.motion import Axis, Limits, State
from teleop.planner.polynomial import Array
from teleop.sinks.take_format import ABOUT, END, FORMAT, LIMITS, About

if TYPE_CHECKING:
    from mcap.records import McapRecord

RECORD_LIMIT = 1 << 26  # bytes: a longer record is damage


@dataclass(frozen=True)
class Ending:
    """Why a run stopped, and how many of its ticks the recorder had to leave out."""

    result: str
    reasons: Sequence[str]
    dropped: int


@dataclass(frozen=True, eq=False)
class Take:
    """Times are seconds from the first tick. `motion` has rows position, velocity, acceleration (3, n) at `times` (n,).

    `measured` has rows time, position (2, m). `events` are (time, topic, content) of everything else, in their order.
    `ending` is None for a file that was cut, and `lost` the bytes at its end that could not be read.
    """

    path: Path
    about: About
    times: Array
    motion: Mapping[Axis, Array]
    measured: Mapping[Axis, Array]
    events: Sequence[tuple[float, str, Mapping[str, Any]]]
    ending: Ending | None
    lost: int

    @property
    def axes(self) -> Sequence[Axis]:
        return list(self.motion)

    @property
    def duration(self) -> float:
        """Seconds from the first to the last tick."""
        return float(self.times[-1]) if len(self.times) else 0.0

    @property
    def ended(self) -> str:
        """How the run ended, in words."""
        if self.ending is None:
            return "cut"
        return ": ".join([self.ending.result, "; ".join(self.ending.reasons)]).removesuffix(": ")

    @cached_property
    def actions(self) -> Sequence[tuple[float, Mapping[str, Any]]]:
        return [(time, content) for time, topic, content in self.events if topic == "/actions"]

    def state(self, axis: Axis, index: int) -> State:
        """Where the axis was commanded to be at tick `index`."""
        return State(*self.motion[axis][:, index].tolist())


def read_take(path: Path) -> Take:
    """The take in a file; raises DocumentError when it cannot be read at all, or is not a take."""
    reading = _Reading(path)
    try:
        for record in whole_records(path, reading):
            reading.add(record)
    except OSError as error:
        raise DocumentError([f"{path}: cannot be read: {error.strerror or error}"]) from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise DocumentError([f"{path}: is not a take as this program writes it: {error}"]) from None
    return reading.take()


@dataclass
class Progress:
    """How far a file could be read: `whole` bytes of `size`."""

    whole: int = 0
    size: int = 0


def whole_records(path: Path, progress: Progress) -> Iterator[McapRecord]:
    """Every whole record of a file, those in chunks too, up to where it was cut; raises OSError, DocumentError."""
    import zstandard
    from mcap.exceptions import McapError
    from mcap.stream_reader import StreamReader

    progress.size = path.stat().st_size
    with path.open("rb") as stream:
        records = StreamReader(stream, validate_crcs=True, record_size_limit=RECORD_LIMIT).records
        while True:
            try:
                record = next(records)
            except StopIteration:
                progress.whole = stream.tell()
                return
            except (McapError, ValueError, StructError, zstandard.ZstdError) as error:
                if progress.whole == 0:
                    wrong = f"{path}: is not a take (.mcap), or was cut before anything was in it"
                    raise DocumentError([wrong]) from error
                return
            progress.whole = stream.tell()
            yield record


class _Reading(Progress):
    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self.about: About | None = None
        self.ending: Ending | None = None
        self._topics: dict[int, str] = {}
        self._started = 0
        self._times: list[float] = []
        self._motion: dict[Axis, list[Sequence[float]]] = {}
        self._measured: dict[Axis, list[tuple[float, float]]] = {}
        self._events: list[tuple[float, str, Mapping[str, Any]]] = []

    def add(self, record: McapRecord) -> None:
        from mcap.records import Channel, Message, Metadata

        if isinstance(record, Message):
            if self.about is None:
                raise ValueError("it does not say what it is")
            self._message((record.log_time - self._started) / 1e9, self._topics[record.channel_id], record.data)
        elif isinstance(record, Channel):
            self._topics[record.id] = record.topic
        elif isinstance(record, Metadata) and record.name == ABOUT:
            self.about = _about(record.metadata)
            self._started = round(self.about.started * 1e9)
            self._motion = {axis: [] for axis in self.about.limits}
        elif isinstance(record, Metadata) and record.name == END:
            said = record.metadata
            self.ending = Ending(said["result"], json.loads(said["reasons"]), int(said["dropped"]))

    def _message(self, time: float, topic: str, data: bytes) -> None:
        content = json.loads(data)
        if topic == "/motion":
            self._times.append(time)
            for axis, rows in self._motion.items():
                state = content[axis.value]
                rows.append((state["position"], state["velocity"], state["acceleration"]))
        elif topic == "/measured":
            for name, position in content.items():
                self._measured.setdefault(Axis(name), []).append((time, position))
        else:
            self._events.append((time, topic, content))

    def take(self) -> Take:
        if self.about is None:
            raise DocumentError([f"{self.path}: is not a take of this program"])
        motion = {axis: np.array(rows, float).reshape(-1, 3).T for axis, rows in self._motion.items()}
        measured = {axis: np.array(rows, float).T for axis, rows in self._measured.items()}
        times = np.array(self._times, float)
        lost = self.size - self.whole
        return Take(self.path, self.about, times, motion, measured, self._events, self.ending, lost)


def _about(said: Mapping[str, str]) -> About:
    if said.get("format") != FORMAT:
        raise ValueError(f"its format is {said.get('format')!r}, and this program reads {FORMAT!r}")
    limits = {}
    for name, of_axis in json.loads(said["axes"]).items():
        low, high, *magnitudes = (of_axis[name] for name in LIMITS)
        low, high = (-math.inf if low is None else low), (math.inf if high is None else high)
        limits[Axis(name)] = Limits(low, high, *magnitudes)
    return About(said["rig"], said["title"], float(said["started"]), limits, said["version"])
