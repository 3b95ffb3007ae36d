"""What is in a take, without its motion: for a list of many files, and for a closer look at one.

A list of a day's takes must not read gigabytes, so of a file that was closed only the index and the two records that
say what it is are read; one that was not is read as a stream, which tells how much of it there is.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from struct import error as StructError  # noqa: N812 - it is an error
from typing import Any

from teleop.config.documents.document import DocumentError
from teleop.recording import ENDING
from teleop.recording.format import ABOUT, END, About
from teleop.recording.messages import Ending, Messages, about, ending, reading_errors
from teleop.recording.records import RECORD_LIMIT
from teleop.recording.topics import SCHEMAS


@dataclass
class Summary:
    """A take in a few numbers: `counts` are messages by topic, `lost` bytes at the end that could not be read.

    `ending` is None where the file does not say how the run ended; `remark` is about one that is not whole.
    `actions` are (s from the first tick, what was done once).
    """

    path: Path
    about: About
    seconds: float
    ending: Ending | None = None
    remark: str = ""
    lost: int = 0
    counts: Mapping[str, int] = field(default_factory=dict)
    actions: Sequence[tuple[float, Mapping[str, Any]]] = ()


def takes_in(folder: Path) -> Iterator[tuple[Path, Summary | str]]:
    """Every .mcap file of a folder by name, glanced at; a sentence for one that cannot be used.

    Raises DocumentError when the folder cannot be read.
    """
    try:
        files = sorted(each for each in folder.iterdir() if each.suffix.lower() == ENDING and each.is_file())
    except OSError as error:
        raise DocumentError([f"{folder}: cannot be listed: {error.strerror or error}"]) from None
    for file in files:
        try:
            yield file, summarize_index(file)
        except DocumentError as error:
            yield file, error.problems[0].removeprefix(f"{file}: ")


def summarize_index(path: Path) -> Summary:
    """What a file's index says of it; one without an index is read through. Raises DocumentError for no take."""
    with reading_errors(path):
        metadata = _metadata(path)
        if ABOUT in metadata and END in metadata:
            return Summary(path, about(metadata[ABOUT]), float(metadata[END]["seconds"]), ending(metadata[END]))
    return summarize(path)


def summarize(path: Path) -> Summary:
    """The whole file, read once; raises DocumentError for what cannot be read or is no take."""
    messages = Messages(path)
    counts: dict[str, int] = dict.fromkeys(SCHEMAS, 0)
    actions = []
    seconds = 0.0
    with reading_errors(path):
        for time, topic, data in messages:
            counts[topic] = counts.get(topic, 0) + 1
            if topic == "/motion":
                seconds = time
            elif topic == "/actions":
                actions.append((time, json.loads(data)))
    return Summary(path, messages.about, seconds, messages.ending, messages.remark, messages.lost, counts, actions)


def _metadata(path: Path) -> Mapping[str, Mapping[str, str]]:
    """The metadata records that the index leads to, nothing where it leads nowhere; raises OSError."""
    from mcap.exceptions import McapError
    from mcap.reader import SeekingReader

    with path.open("rb") as stream:
        try:
            reader = SeekingReader(stream, validate_crcs=True, record_size_limit=RECORD_LIMIT)
            return {record.name: record.metadata for record in reader.iter_metadata()}
        except (OSError, McapError, ValueError, StructError, MemoryError, OverflowError):  # cut, or damaged
            return {}
