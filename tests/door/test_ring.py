"""The ring of states: the newest one, whole, or none; between two processes too."""

from __future__ import annotations

import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from teleop.door.address import new_door
from teleop.door.ring import HEAD, LARGEST, SLOT_HEAD, SLOT_SIZE, SLOTS, RingError, RingReader, RingWriter


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "ring"


@pytest.fixture
def both(path: Path) -> Iterator[tuple[RingWriter, RingReader]]:
    writer = RingWriter(path)
    reader = RingReader(path)
    yield writer, reader
    reader.close()
    writer.close()


def test_the_newest_state_is_read_and_256_are_kept(both: tuple[RingWriter, RingReader]) -> None:
    writer, reader = both
    assert reader.newest() is None
    for number in range(1, 3 * SLOTS):
        writer.write(b"%d" % number)
        assert reader.newest() == (number, b"%d" % number)
    newest = 3 * SLOTS - 1
    assert SLOTS >= 256
    assert [reader.read(number) for number in range(newest - SLOTS + 1, newest + 1)] == [
        b"%d" % number for number in range(newest - SLOTS + 1, newest + 1)
    ]
    assert reader.read(newest - SLOTS) is None


def test_a_state_that_is_being_written_is_passed_over(both: tuple[RingWriter, RingReader]) -> None:
    writer, reader = both
    writer.write(b"whole")
    writer.write(b"next")
    writer._words[(HEAD + 2 * SLOT_SIZE) // 8] = 2 * 2 - 1  # as while it is written
    assert reader.newest() == (1, b"whole")


def test_a_torn_state_is_seen_and_passed_over(both: tuple[RingWriter, RingReader]) -> None:
    writer, reader = both
    writer.write(b"whole")
    writer.write(b"torn, because half of it is of another")
    writer._map[HEAD + 2 * SLOT_SIZE + SLOT_HEAD + 3] ^= 1
    assert reader.newest() == (1, b"whole")
    assert reader.torn == 1


def test_a_state_that_is_too_large_is_refused(both: tuple[RingWriter, RingReader]) -> None:
    writer, reader = both
    with pytest.raises(ValueError, match="a slot has"):
        writer.write(bytes(LARGEST + 1))
    writer.write(bytes(LARGEST))
    assert reader.newest() == (1, bytes(LARGEST))


def test_a_file_that_is_no_ring_is_refused(path: Path) -> None:
    with pytest.raises(RingError):
        RingReader(path)
    for content in (b"", b"short", bytes(HEAD + SLOTS * SLOT_SIZE)):
        path.write_bytes(content)
        with pytest.raises(RingError):
            RingReader(path)


def test_the_door_is_this_users_alone_and_is_gone_afterwards() -> None:
    with new_door() as door:
        writer = RingWriter(door.ring)
        assert stat.S_IMODE(door.folder.stat().st_mode) == 0o700
        assert stat.S_IMODE(door.ring.stat().st_mode) == 0o600
        writer.close()
    assert not door.folder.exists()


WRITES = """
import sys
from pathlib import Path
from teleop.door.ring import RingWriter
writer = RingWriter(Path(sys.argv[1]))
print("made", flush=True)
for number in range(1, 30001):
    writer.write(bytes([number % 251]) * (200 + number % 1000))
"""


def test_a_reader_in_another_process_never_gets_a_torn_state(path: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", WRITES, str(path)], stdout=subprocess.PIPE) as writer:
        assert writer.stdout is not None
        writer.stdout.readline()
        reader, seen = RingReader(path), 0
        while seen < 30000:
            if (newest := reader.newest()) is None:
                continue
            number, data = newest
            assert number >= seen
            assert data == bytes([number % 251]) * (200 + number % 1000)
            seen = number
        reader.close()
    assert writer.returncode == 0
