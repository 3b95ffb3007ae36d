"""The journal: what it knows after any end, whom it belongs to, and who may not have it."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest
from waiting import wait_until

from teleop.core.errors import UsageError
from teleop.timelapse.journal import TRIES, FrameState, Shoot, open_journal

SHOOT = Shoot("dusk.yaml", "abc", 720)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "dusk.journal"


def left_at(path: Path, *states: FrameState, finished: bool = False) -> None:
    """A journal whose first frames are in these states."""
    with open_journal(path, SHOOT, restart=True) as journal:
        for frame, state in enumerate(states):
            journal.note(frame, state)
        if finished:
            journal.finish()


@pytest.mark.parametrize(
    ("states", "next_frame", "in_doubt"),
    [
        ((), 0, None),
        ((FrameState.DONE, FrameState.DONE), 2, None),
        ((FrameState.DONE, FrameState.BEGUN), 1, 1),
        ((FrameState.DONE, FrameState.UNSHOT), 1, None),
        ((FrameState.DONE, FrameState.MISSED, FrameState.DOUBTFUL), 3, None),
    ],
)
def test_it_knows_which_frame_is_next(
    path: Path, states: tuple[FrameState, ...], next_frame: int, in_doubt: int | None
) -> None:
    left_at(path, *states)
    with open_journal(path, SHOOT, resume=True) as journal:
        assert (journal.next, journal.in_doubt) == (next_frame, in_doubt)


@pytest.mark.parametrize("patient", [True, False])
def test_a_note_is_safe_once_another_connection_can_read_it(path: Path, patient: bool) -> None:
    with open_journal(path, SHOOT, patient=patient) as journal:
        note = journal.note(0, FrameState.BEGUN)
        if patient:
            assert note.safe
        wait_until(lambda: note.safe, "safe")
    with sqlite3.connect(path) as database:
        assert database.execute("SELECT * FROM frames").fetchall() == [(0, "begun")]


def test_it_is_written_ahead_and_synchronously(path: Path) -> None:
    with open_journal(path, SHOOT) as journal:
        [[mode]] = journal._database.execute("PRAGMA journal_mode")
        [[synchronous]] = journal._database.execute("PRAGMA synchronous")
        assert (mode, synchronous) == ("wal", 2)


@pytest.mark.parametrize(
    ("states", "finished", "shoot", "how", "said"),
    [
        (
            (FrameState.DONE,),
            False,
            SHOOT,
            {},
            "shoot of dusk.yaml stopped at frame 1 of 720: continue with --resume",
        ),
        (
            (FrameState.DONE,),
            False,
            Shoot("dusk.yaml", "x", 720),
            {},
            "stopped at frame 1 of 720: start over with",
        ),
        (
            (FrameState.DONE,),
            False,
            Shoot("dusk.yaml", "x", 720),
            {"resume": True},
            "stopped at frame 1 of 720, and dusk.yaml has changed since: restore it, or start over",
        ),
        ((FrameState.DONE,), False, Shoot("x.yaml", "x", 9), {"resume": True}, "and it is another file"),
        ((FrameState.DONE,), True, SHOOT, {"resume": True}, "no shoot to resume"),
    ],
)
def test_it_refuses_what_nobody_can_have_meant(
    path: Path, states: tuple[FrameState, ...], finished: bool, shoot: Shoot, how: dict[str, bool], said: str
) -> None:
    left_at(path, *states, finished=finished)
    with pytest.raises(UsageError) as caught, open_journal(path, shoot, **how):
        pass
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)
    with open_journal(path, SHOOT, restart=True) as journal:
        assert journal.frames == {}


def test_without_a_journal_there_is_nothing_to_resume(path: Path) -> None:
    with pytest.raises(UsageError, match=r"no dusk\.journal in"), open_journal(path, SHOOT, resume=True):
        pass
    assert not path.exists()


def test_a_finished_shoot_and_one_that_never_began_are_simply_begun(path: Path) -> None:
    left_at(path)
    left_at(path, FrameState.DONE, finished=True)
    with open_journal(path, SHOOT) as journal:
        assert journal.next == 0


def test_a_second_hand_is_refused_and_the_first_goes_on(path: Path) -> None:
    with open_journal(path, SHOOT) as journal:
        journal.note(0, FrameState.DONE)
        said = "another teleop is shooting with this journal"
        with pytest.raises(UsageError, match=said), open_journal(path, SHOOT, resume=True):
            pass
        note = journal.note(1, FrameState.BEGUN)
        wait_until(lambda: note.safe, "safe")


def test_what_is_no_journal_is_left_alone(path: Path) -> None:
    path.write_bytes(b"my diary" * 1000)
    with pytest.raises(UsageError, match="is not a timelapse journal"), open_journal(path, SHOOT, restart=True):
        pass
    assert path.read_bytes() == b"my diary" * 1000


def test_a_folder_that_cannot_be_written_is_said(path: Path) -> None:
    said = "cannot be used: unable to open database file"
    with pytest.raises(UsageError, match=said), open_journal(path.parent / "nowhere" / "x.journal", SHOOT):
        pass


def test_whatever_fails_in_its_thread_is_said_and_keeps_nobody_waiting(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Broken:
        def execute(self, *_arguments: object) -> None:
            raise ZeroDivisionError("a defect")

        def close(self) -> None: ...

    with open_journal(path, SHOOT) as journal:
        monkeypatch.setattr(journal, "_database", Broken())
        note = journal.note(0, FrameState.BEGUN)
        wait_until(lambda: journal.trouble, "trouble")
        assert journal.trouble == f"{path} cannot be written: a defect"
        assert not note.safe
        assert not journal.note(1, FrameState.BEGUN).safe
        journal.catch_up()


class Full:
    """A disk that takes nothing for so many writes."""

    def __init__(self, database: sqlite3.Connection, times: int) -> None:
        self._database, self._left = database, times

    def execute(self, *arguments) -> object:
        self._left -= 1
        if self._left >= 0:
            raise sqlite3.OperationalError("database or disk is full")
        return self._database.execute(*arguments)

    def close(self) -> None:
        self._database.close()


def test_one_failed_write_is_tried_again_before_the_next(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_journal(path, SHOOT, patient=True) as journal:
        monkeypatch.setattr(journal, "_database", Full(journal._database, 1))
        first = journal.note(0, FrameState.BEGUN)
        assert (first.safe, first.failed, journal.trouble, journal.frames) == (False, True, "", {})
        second = journal.note(0, FrameState.DONE)
        assert (first.safe, first.failed, second.safe) == (True, False, True)
        assert journal.frames == {0: FrameState.DONE}


def test_a_write_that_fails_time_and_again_is_trouble(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_journal(path, SHOOT, patient=True) as journal:
        monkeypatch.setattr(journal, "_database", Full(journal._database, TRIES))
        for _ in range(TRIES):
            assert journal.trouble == ""
            journal.note(0, FrameState.BEGUN)
        assert journal.trouble == f"{path} cannot be written: database or disk is full"


def test_a_damaged_journal_is_said_with_what_to_do(path: Path) -> None:
    with open_journal(path, SHOOT, patient=True) as journal:
        for frame in range(100):
            journal.note(frame, FrameState.DONE)
    whole = path.read_bytes()
    path.write_bytes(whole[:4096] + b"\x55" * (len(whole) - 4096))
    with pytest.raises(UsageError) as caught, open_journal(path, SHOOT, resume=True):
        pass
    assert str(caught.value).startswith(
        f"{path}: is damaged (database disk image is malformed): move it away and start"
    )
