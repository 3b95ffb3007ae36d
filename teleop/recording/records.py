"""The records of an MCAP file that may be cut or damaged, as far as they are whole.

A process that was killed leaves no index and half a chunk, so a file is read as a stream, to the last record that is
whole and keeps its checksum. What lies behind damage is not used: a recording with a hole in it is none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from struct import error as StructError  # noqa: N812 - it is an error
from typing import TYPE_CHECKING

from teleop.config.documents.document import DocumentError

if TYPE_CHECKING:
    from mcap.records import McapRecord

RECORD_LIMIT = 1 << 26  # bytes: a longer record is damage


@dataclass
class Progress:
    """How far a file could be read: `whole` bytes of `size`; `closed` once its index and its end are there too."""

    whole: int = 0
    size: int = 0
    closed: bool = False


def whole_records(path: Path, progress: Progress) -> Iterator[McapRecord]:
    """Every whole record of a file, those in chunks too, up to where it was cut; raises OSError, DocumentError."""
    import zstandard
    from mcap.exceptions import McapError
    from mcap.stream_reader import StreamReader

    damage = McapError, ValueError, StructError, zstandard.ZstdError, MemoryError, OverflowError
    progress.size = path.stat().st_size
    with path.open("rb") as stream:
        records = StreamReader(stream, validate_crcs=True, record_size_limit=RECORD_LIMIT).records
        while True:
            try:
                record = next(records)
            except StopIteration:
                progress.whole = stream.tell()
                progress.closed = progress.whole == progress.size
                return
            except damage as error:
                if progress.whole == 0:
                    wrong = f"{path}: not a take (.mcap), or cut off before anything was recorded"
                    raise DocumentError([wrong]) from error
                return
            progress.whole = stream.tell()
            yield record
