"""The recorder: an observer that never makes the motion wait for a disk.

The control thread only appends the tick, which no longer changes, to a bounded queue. A thread of the recorder's
own encodes, compresses and writes, and gives way after every tick, because the interpreter would otherwise keep the
control thread waiting for a switch interval. Whatever the disk does (full, gone, stuck) ends in a count of what is
missing and a sentence that says so; a thread stuck in the kernel is left behind at the end, as nothing can wake it.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from threading import Event, Thread
from typing import IO, BinaryIO, cast

from teleop.core.axes import Axis, Limits
from teleop.core.clock import date
from teleop.core.errors import UsageError
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.recording import ENDING
from teleop.recording.format import NO_SEQUENCE, About, TakeWriter
from teleop.recording.played import SequenceFacts

CAPACITY = 6000  # ticks in the queue: a minute of a disk that does not answer
POLL = 0.1  # s between looks at the queue
FLUSH = 8  # looks between flushes: what kill -9 loses is younger than a second
FINISH_TIMEOUT = 3.0  # s at the end for what is still in the queue
HUNG_NAPS = 6000  # naps, 3 s at least, without a tick taken out: then the disk counts as gone
NAP = 0.0005  # s that a run in virtual time waits for room

Status = Callable[[], object]


class Recorder:
    """An observer that writes to `stream`, an unbuffered file; `name` is what its user calls it.

    `status` is asked each tick in the control thread for a value that no longer changes. `patient` is for
    runs in virtual time, which may wait for the disk: in real time what does not fit into the queue is dropped.
    """

    def __init__(
        self, stream: IO[bytes], about: About, name: str, status: Status | None = None, patient: bool = False
    ) -> None:
        self._stream, self._about, self._name = _Whole(stream), about, name
        self.status, self._patient = status, patient
        self._queue: deque[tuple[Tick, object]] = deque()
        self._failure = ""
        self._dropped = 0  # by the control thread; the other counts are the writer thread's
        self._taken = self._safe = 0  # ticks out of the queue, and those of them in whole chunks of the file
        self._seconds = 0.0
        self._over = Event()
        self._ended: tuple[str, Sequence[str]] = ("", ())
        self._links: Mapping[str, Mapping[str, int]] = {}
        self._thread = Thread(target=self._work, name="recorder", daemon=True)
        self._thread.start()

    def observe(self, tick: Tick) -> None:
        queue = self._queue
        status = None if self.status is None else self.status()
        if self._patient:
            self._wait_for_room()
        if self._failure or len(queue) >= CAPACITY:
            self._dropped += 1
        else:
            queue.append((tick, status))

    def finish(
        self, result: Result, reasons: Sequence[str], links: Mapping[str, Mapping[str, int]] | None = None
    ) -> None:
        """The run is over: write what is left, why it stopped, and what its links counted.

        Waits FINISH_TIMEOUT seconds at most.
        """
        self._ended, self._links = (result.name.lower(), list(reasons)), links or {}
        self._over.set()
        self._thread.join(FINISH_TIMEOUT)
        if self._thread.is_alive():
            self._failure = self._failure or "the disk does not answer"

    def __str__(self) -> str:
        return f"{self._name}: {self._seconds:.2f} s in {self._stream.count / 1000:.0f} kB"

    @property
    def begun(self) -> bool:
        """Whether there was anything to record."""
        return bool(self._taken or self._queue or self._dropped)

    @property
    def seconds(self) -> float:
        """How long the take is by now, of what has been taken out of the queue."""
        return self._seconds

    @property
    def trouble(self) -> str:
        """What is wrong with the recording, "" while nothing is; may be asked at any time, from any thread."""
        missing = self.missing
        if not missing and not self._failure:
            return ""
        lost = f"{missing} tick{'' if missing == 1 else 's'} not recorded"
        return f"{self._name}: {self._failure or 'the disk is too slow'}: {lost}"

    @property
    def missing(self) -> int:
        """Ticks that are not in the file, or will not be, as it is known by now."""
        return self._dropped + (self._taken - self._safe + len(self._queue) if self._failure else 0)

    @property
    def facts(self) -> Mapping[str, object]:
        """For a report: the file, how much is safely in it, and what is missing."""
        size = {"ticks": self._safe, "seconds": round(self._seconds, 3), "bytes": self._stream.count}
        return {"file": self._name, **size, "missing": self.missing, "trouble": self.trouble}

    def _wait_for_room(self) -> None:
        taken, naps = self._taken, 0
        while len(self._queue) >= CAPACITY and not self._failure and not self._over.is_set():
            time.sleep(NAP)
            taken, naps = (self._taken, 0) if self._taken != taken else (taken, naps + 1)
            if naps > HUNG_NAPS:
                self._failure = "the disk does not answer"

    def _work(self) -> None:
        try:
            self._write_all()
        except Exception as error:  # noqa: BLE001 - whatever a disk or an encoder does must not reach the motion
            reason = error.strerror if isinstance(error, OSError) else None
            self._failure = reason or f"{type(error).__name__}: {error}"

    def _write_all(self) -> None:
        writer = TakeWriter(cast(BinaryIO, self._stream), self._about)
        over, looks = False, 0
        while not over:
            over = self._over.wait(POLL)
            while self._queue:
                tick, status = self._queue.popleft()
                self._taken += 1
                writer.add(tick, status)
                time.sleep(0)  # the control thread goes first
            looks += 1
            if (looks >= FLUSH and self._taken > self._safe) or over:
                writer.flush()
                looks, self._safe, self._seconds = 0, self._taken, writer.seconds
        writer.end(*self._ended, self._dropped, self._links)


class _Whole:
    """A stream whose writes are whole or raise: a raw file may take half of what it is given, and say so."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream
        self.count = 0

    def write(self, data: bytes) -> int:
        rest = memoryview(data)
        while rest:
            taken = self._stream.write(rest)
            rest = rest[taken:]
            self.count += taken
        return len(data)

    def flush(self) -> None:
        self._stream.flush()

    def tell(self) -> int:
        return self.count


@contextmanager
def recording(
    path: Path | None,
    rig: str,
    title: str,
    limits: Mapping[Axis, Limits],
    status: Status | None = None,
    *,
    patient: bool = False,
    option: str = "",
    sequence: SequenceFacts = NO_SEQUENCE,
) -> Iterator[Recorder | None]:
    """A recorder into a new file, None for no path; `limits` are those of the axes in use, `sequence` is
    what is played.

    Raises UsageError, which begins with `option`, when the file cannot be made or already exists. Its caller
    calls `finish`; a block that is left without has failed, and leaves no file when nothing had begun.
    """
    if path is None:
        yield None
        return
    about = About(rig, title, date(), limits, version("rs-teleop"), sequence)
    with _created(path, option) as stream:
        recorder = Recorder(stream, about, str(path), status, patient)
        try:
            yield recorder
        except BaseException as error:
            recorder.finish(Result.FAILED, [str(error) or type(error).__name__])
            if not recorder.begun:
                path.unlink(missing_ok=True)
            raise


def _created(path: Path, option: str) -> IO[bytes]:
    if path.suffix.lower() != ENDING:
        raise UsageError(f"{option}{path}: its ending must be {ENDING}")
    try:
        return path.open("xb", buffering=0)
    except FileExistsError:
        raise UsageError(f"{option}{path}: already exists; choose another name, a take is never overwritten") from None
    except OSError as error:
        raise UsageError(f"{option}{path}: cannot be written: {error.strerror or error}") from None
