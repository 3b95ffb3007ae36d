"""The newest states of a rig in a file that both sides have mapped: one process writes, any number read, none waits.

Each slot has a sequence word, which is odd while the slot is written, and a checksum: a reader that finds the word odd
or changed, or the checksum wrong, has a torn copy and takes the state before it. The checksum is there because a
processor may let another one see two stores in the other order, and Python has no barrier against that.
"""

from __future__ import annotations

import mmap
import os
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

from teleop.core.errors import TeleopError

SLOTS = 256
SLOT_SIZE = 32768  # bytes; the file is sparse, so only what was written takes memory
MAGIC = 0x31474E49524F4554  # "TEORING1"
HEAD = 64  # bytes before the first slot: magic, slots, slot size, number of the newest state
SLOT_HEAD = 24  # bytes: sequence word, length, checksum
LARGEST = SLOT_SIZE - SLOT_HEAD
TRIES = 8  # states, newest first, until one is whole


class RingError(TeleopError):
    """The file is no ring, or cannot be mapped."""


class Numbered(NamedTuple):
    """A state as bytes, and its number, from 1."""

    number: int
    data: bytes


class RingWriter:
    """Makes the file (mode 0600), which must not be there yet. One process writes to a ring, from one thread."""

    def __init__(self, path: Path) -> None:
        descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o600)
        try:
            size = HEAD + SLOTS * SLOT_SIZE
            os.ftruncate(descriptor, size)
            self._map = mmap.mmap(descriptor, size, access=mmap.ACCESS_WRITE)
        finally:
            os.close(descriptor)
        self._words = memoryview(self._map).cast("Q")
        self.number = 0
        self._words[1], self._words[2] = SLOTS, SLOT_SIZE
        self._words[0] = MAGIC

    def write(self, data: bytes) -> None:
        """The newest state from now on. Raises ValueError for more bytes than LARGEST."""
        if len(data) > LARGEST:
            raise ValueError(f"a state of {len(data)} bytes: a slot has {LARGEST}")
        number = self.number + 1
        place = HEAD + number % SLOTS * SLOT_SIZE
        word = place // 8
        self._words[word] = 2 * number - 1
        self._map[place + SLOT_HEAD : place + SLOT_HEAD + len(data)] = data
        self._words[word + 1], self._words[word + 2] = len(data), crc32(data)
        self._words[word] = 2 * number
        self._words[3] = self.number = number

    def close(self) -> None:
        self._words.release()
        self._map.close()


class RingReader:
    """Raises RingError for a file that is no ring."""

    def __init__(self, path: Path) -> None:
        try:
            descriptor = os.open(path, os.O_RDONLY)
            try:
                self._map = mmap.mmap(descriptor, 0, access=mmap.ACCESS_READ)
            finally:
                os.close(descriptor)
        except (OSError, ValueError) as error:
            raise RingError(f"{path}: {error}") from None
        whole = len(self._map) == HEAD + SLOTS * SLOT_SIZE
        self._words = memoryview(self._map).cast("Q") if whole else memoryview(b"").cast("Q")
        if not whole or tuple(self._words[:3]) != (MAGIC, SLOTS, SLOT_SIZE):
            self.close()
            raise RingError(f"{path}: is no ring of this version of teleop")
        self.torn = 0  # copies that were not whole

    @property
    def number(self) -> int:
        """Of the newest state, 0 before there is one."""
        return self._words[3]

    def newest(self) -> Numbered | None:
        """The newest state that is whole, None before there is one."""
        number = self.number
        for earlier in range(TRIES):
            if (data := self.read(number - earlier)) is not None:
                return Numbered(number - earlier, data)
        return None

    def read(self, number: int) -> bytes | None:
        """The state of that number, None where it is overwritten, not whole or not there yet."""
        place = HEAD + number % SLOTS * SLOT_SIZE
        word = place // 8
        if number < 1 or self._words[word] != 2 * number:
            return None
        length, checksum = self._words[word + 1], self._words[word + 2]
        data = self._map[place + SLOT_HEAD : place + SLOT_HEAD + min(length, LARGEST)]
        if self._words[word] == 2 * number and crc32(data) == checksum:
            return data
        self.torn += 1
        return None

    def close(self) -> None:
        self._words.release()
        self._map.close()
