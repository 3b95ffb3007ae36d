"""The journal of a timelapse: which frame is next, known after a power cut.

A frame is written down before its shutter and again after it, and the shutter waits until the first is on the disk. So
what a killed process leaves behind is exact: a frame is shot, or it is not, or it is the one whose shutter was due just
then. The journal knows the shoot by what its file says, and nothing of the rig: the same shoot may go on over another
link. The process that has it open holds SQLite's exclusive lock, which ends with that process, however it ends.

A commit takes half a millisecond, but a disk may stall: a thread writes, and the control thread only looks whether it
is done. Where time is virtual the disk has to be waited for, so there the caller writes.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread

from teleop.core.errors import UsageError

ENDING = ".journal"
FORMAT = 1  # of the tables
TRIES = 3  # of a write, until the journal counts as one that can no longer be written
DISK_TIMEOUT = 3.0  # s at the end for what is still to be written

_TABLES = """
CREATE TABLE IF NOT EXISTS shoot (name TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS frames (frame INTEGER PRIMARY KEY, state TEXT NOT NULL);
"""


class FrameState(StrEnum):
    """What is known of a frame; one that is not in the journal has not been touched."""

    BEGUN = "begun"  # its shutter is due: shot or not, that is not known
    DONE = "done"
    UNSHOT = "unshot"  # begun, and known not to have been shot
    MISSED = "missed"  # not shot, and the camera is past it
    DOUBTFUL = "doubtful"  # counts as shot, and may not be


OVER = (FrameState.DONE, FrameState.MISSED, FrameState.DOUBTFUL)  # the shoot is past such a frame


@dataclass
class Note:
    """Something to be written; `safe` once it is on the disk. `frame` None is the end of the shoot.

    `failed` is one that could not be written: it is tried again before the next.
    """

    frame: int | None
    state: FrameState
    safe: bool = False
    failed: bool = False


class Journal:
    """An open journal; `frames` is what is on the disk of each frame.

    `patient` has `note` wait for the disk. A journal that can no longer be written says so in `trouble`.
    """

    def __init__(self, path: Path, database: sqlite3.Connection, frames: dict[int, FrameState], patient: bool) -> None:
        self.path, self.frames, self.trouble = path, frames, ""
        self._database, self._patient = database, patient
        self._unwritten: list[Note] = []  # in their order
        self._failures = 0  # in a row
        self._queue: SimpleQueue[Note | Event | None] = SimpleQueue()
        self._thread = Thread(target=self._work, name="journal", daemon=True)
        if not patient:
            self._thread.start()

    @property
    def next(self) -> int:
        """The first frame that the shoot is not past."""
        return next_frame(self.frames)

    @property
    def in_doubt(self) -> int | None:
        """The frame that was begun and never confirmed."""
        return next((frame for frame, state in self.frames.items() if state is FrameState.BEGUN), None)

    def note(self, frame: int | None, state: FrameState) -> Note:
        """Write down a frame; at once, or by the thread, in the order of the calls."""
        note = Note(frame, state)
        if self._patient:
            self._write(note)
        else:
            self._queue.put(note)
        return note

    def finish(self) -> Note:
        """The last frame has been shot."""
        return self.note(None, FrameState.DONE)

    def catch_up(self) -> None:
        """Wait for everything noted so far, but not for ever."""
        done = Event()
        if not self._patient:
            self._queue.put(done)
            done.wait(DISK_TIMEOUT)

    def close(self) -> None:
        """Write what is left; a disk that does not answer is left behind."""
        if self._patient:
            self._database.close()
            return
        self._queue.put(None)
        self._thread.join(DISK_TIMEOUT)
        if self._thread.is_alive():
            self.trouble = self.trouble or f"{self.path}: the disk does not answer"

    def _work(self) -> None:
        with closing(self._database):
            while (asked := self._queue.get()) is not None:
                asked.set() if isinstance(asked, Event) else self._write(asked)

    def _write(self, note: Note) -> None:
        """Write what failed before, and this; in vain as long as nothing can be written."""
        self._unwritten.append(note)
        while self._unwritten and not self.trouble:
            first = self._unwritten[0]
            try:
                self._put(first)
            except sqlite3.Error as error:
                self._failures += 1
                if self._failures >= TRIES:
                    self.trouble = f"{self.path} cannot be written: {error}"
                first.failed = note.failed = True
                return
            except Exception as error:  # noqa: BLE001 - a thread that ended unseen would let slot after slot be missed
                self.trouble = f"{self.path} cannot be written: {error or type(error).__name__}"
                return
            self._failures = 0
            del self._unwritten[0]
            first.safe, first.failed = True, False

    def _put(self, note: Note) -> None:
        if note.frame is None:
            self._database.execute("INSERT OR REPLACE INTO shoot VALUES ('finished', 1)")
        else:
            self._database.execute("INSERT OR REPLACE INTO frames VALUES (?, ?)", (note.frame, note.state.value))
            self.frames[note.frame] = note.state


@dataclass(frozen=True)
class Shoot:
    """What a journal belongs to: `file` as the user calls it, `identity` of what it says, and its number of frames."""

    file: str
    identity: str
    frames: int


@contextmanager
def open_journal(
    path: Path, shoot: Shoot, *, resume: bool = False, restart: bool = False, patient: bool = False
) -> Iterator[Journal]:
    """The journal of a shoot at `path`, begun, gone on with (`resume`) or begun anew (`restart`).

    Raises UsageError where none of that is what a user can have meant, and where another process is at it.
    """
    if resume and not path.exists():
        raise UsageError(f"--resume: no shoot to resume: no {path.name} in {path.absolute().parent}")
    try:
        database = _locked(path)
        facts, frames = _read(database)
    except (sqlite3.Error, ValueError) as error:
        raise UsageError(f"{path}: {_explained(error)}") from None
    try:
        _refuse(path, facts, frames, shoot, resume, restart)
        if not resume:
            frames = {}
            _begin(path, database, shoot)
    except UsageError:
        database.close()
        raise
    journal = Journal(path, database, frames, patient)
    try:
        yield journal
    finally:
        journal.close()


def _locked(path: Path) -> sqlite3.Connection:
    """The database, ours alone until this process ends."""
    database = sqlite3.connect(path, timeout=0, isolation_level=None, check_same_thread=False)
    try:
        for pragma in ("locking_mode=EXCLUSIVE", "journal_mode=WAL", "synchronous=FULL"):
            database.execute(f"PRAGMA {pragma}")
        database.executescript(f"BEGIN IMMEDIATE; {_TABLES} COMMIT;")
    except BaseException:
        database.close()
        raise
    return database


def _read(database: sqlite3.Connection) -> tuple[dict[str, object], dict[int, FrameState]]:
    try:
        facts = dict(database.execute("SELECT name, value FROM shoot"))
        frames = {
            int(frame): FrameState(state) for frame, state in database.execute("SELECT * FROM frames ORDER BY frame")
        }
    except (sqlite3.Error, ValueError):
        database.close()
        raise
    return facts, frames


def _begin(path: Path, database: sqlite3.Connection, shoot: Shoot) -> None:
    """Forget whatever shoot there was before, in one transaction."""
    facts = {"format": FORMAT, "file": shoot.file, "identity": shoot.identity, "frames": shoot.frames, "finished": 0}
    try:
        database.execute("BEGIN IMMEDIATE")
        database.execute("DELETE FROM frames")
        database.executemany("INSERT OR REPLACE INTO shoot VALUES (?, ?)", facts.items())
        database.execute("COMMIT")
    except sqlite3.Error as error:
        raise UsageError(f"{path}: {_explained(error)}") from None


def _refuse(
    path: Path, facts: Mapping[str, object], frames: Mapping[int, FrameState], shoot: Shoot, resume: bool, restart: bool
) -> None:
    """Raise UsageError where what was asked for does not go with what the journal says."""
    finished, same = bool(facts.get("finished")), facts.get("identity") == shoot.identity
    left = f"the shoot of {facts.get('file')} stopped at frame {next_frame(frames)} of {facts.get('frames')}"
    if resume and (finished or not facts):
        raise UsageError(f"--resume: no shoot to resume: the shoot of {path} is finished")
    if resume and not same:
        changed = f"{shoot.file} has changed since" if facts.get("file") == shoot.file else "it is another file"
        raise UsageError(f"--resume: {path}: {left}, and {changed}: restore it, or start over with --restart")
    if not resume and not restart and frames and not finished:
        way = "continue with --resume, or start over with --restart" if same else "start over with --restart"
        raise UsageError(f"{path}: {left}: {way}")


def next_frame(frames: Mapping[int, FrameState]) -> int:
    """The first frame that a shoot is not past."""
    return next(frame for frame in range(len(frames) + 1) if frames.get(frame) not in OVER)


_ANEW = "move it away and start the shoot again; the pictures already shot are in the camera"


def _explained(error: Exception) -> str:
    text = str(error)
    if "locked" in text:
        return "another teleop is shooting with this journal"
    if "not a database" in text or isinstance(error, ValueError):
        return f"is not a timelapse journal: {_ANEW}"
    if isinstance(error, sqlite3.DatabaseError) and ("malformed" in text or "corrupt" in text):
        return f"is damaged ({text}): {_ANEW}"
    return f"cannot be used: {text}"
