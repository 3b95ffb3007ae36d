"""Whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from teleop.config.files import OutputError, check_place, replacing, write_text


def test_content_appears_when_the_block_ends(tmp_path: Path) -> None:
    place = tmp_path / "page.html"
    place.write_text("old")
    with replacing(place) as stream:
        stream.write(b"new")
        stream.flush()
        assert place.read_text() == "old"
    assert place.read_text() == "new"
    assert list(tmp_path.iterdir()) == [place]


def fail_half_way(place: Path, error: BaseException) -> None:
    with replacing(place) as stream:
        stream.write(b"half")
        raise error


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_a_block_that_fails_leaves_what_was_there(tmp_path: Path, error: type[BaseException]) -> None:
    place = tmp_path / "page.html"
    place.write_text("old")
    with pytest.raises(error):
        fail_half_way(place, error())
    assert place.read_text() == "old"
    assert list(tmp_path.iterdir()) == [place]


@pytest.fixture
def umask():
    """Sets the umask for one test."""
    before = os.umask(0o022)
    yield os.umask
    os.umask(before)


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.parametrize(("mask", "expected"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
@pytest.mark.parametrize("named", [False, True])
def test_a_new_file_has_the_users_umask(
    tmp_path: Path, umask, mask: int, expected: int, named: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`named`: as on a file system that has no files without a name."""
    if named:
        monkeypatch.delattr(os, "O_TMPFILE")
    umask(mask)
    write_text(tmp_path / "made", "x")
    assert mode(tmp_path / "made") == expected
    assert os.listdir(tmp_path) == ["made"]


def test_a_file_that_is_replaced_keeps_its_mode(tmp_path: Path, umask) -> None:
    umask(0o022)
    (tmp_path / "own").write_text("secret")
    (tmp_path / "own").chmod(0o640)
    write_text(tmp_path / "own", "new")
    assert ((tmp_path / "own").read_text(), mode(tmp_path / "own")) == ("new", 0o640)


def test_a_fifo_stays_one_and_its_reader_gets_the_bytes(tmp_path: Path) -> None:
    fifo = tmp_path / "pipe"
    os.mkfifo(fifo)
    reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)
    with replacing(fifo) as stream:
        stream.write(b"through")
        assert stream.tell() == 7
    assert os.read(reader, 100) == b"through"
    os.close(reader)
    assert stat.S_ISFIFO(fifo.stat().st_mode)
    assert os.listdir(tmp_path) == ["pipe"]


@pytest.mark.parametrize("place", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
@pytest.mark.parametrize("to", ["pipe", "file"])
def test_standard_output_is_written_in_its_place(tmp_path: Path, place: str, to: str) -> None:
    code = f"""
from pathlib import Path
from teleop.config.files import write_text
print("before")
write_text(Path({place!r}), "content\\n")
print("after")
"""
    out = tmp_path / "out"
    with out.open("wb") as file:
        done = subprocess.run(
            [sys.executable, "-c", code], stdout=file if to == "file" else subprocess.PIPE, check=True
        )
    assert (out.read_bytes() if to == "file" else done.stdout) == b"before\ncontent\nafter\n"


def test_a_device_is_written_to_and_not_replaced() -> None:
    write_text(Path("/dev/null"), "gone")
    with pytest.raises(OutputError, match="/dev/full: cannot be written: No space left on device"):
        write_text(Path("/dev/full"), "too much")
    assert stat.S_ISCHR(Path("/dev/null").stat().st_mode)


def test_a_killed_writer_leaves_nothing(tmp_path: Path) -> None:
    place = tmp_path / "page.html"
    place.write_text("old")
    code = f"""
import os, signal
from pathlib import Path
from teleop.config.files import replacing
with replacing(Path({str(place)!r})) as stream:
    stream.write(b"half" * 100000)
    stream.flush()
    os.kill(os.getpid(), signal.SIGKILL)
"""
    try:
        os.close(os.open(tmp_path, os.O_TMPFILE | os.O_WRONLY))
    except OSError as error:
        pytest.skip(f"this file system has no files without a name: {error}")
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == -9
    assert place.read_text() == "old"
    assert os.listdir(tmp_path) == ["page.html"]


def test_what_is_known_beforehand_is_said_beforehand(tmp_path: Path) -> None:
    for place, said in [(tmp_path / "no" / "x", "No such file or directory"), (tmp_path, "it is not a file")]:
        with pytest.raises(OutputError, match=f"{place}: cannot be written: {said}"):
            check_place(place)
    check_place(tmp_path / "new")
    check_place(Path("/dev/stdout"))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("call", ["fsync", "link"])
def test_a_disk_that_is_full_at_the_end_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    place = tmp_path / "page.html"
    place.write_text("old")

    def full(*_arguments: object, **_named: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, call, full)
    with pytest.raises(OutputError, match="No space left on device"):
        write_text(place, "new")
    assert place.read_text() == "old"
    assert os.listdir(tmp_path) == ["page.html"]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("target")
    with replacing(tmp_path / "link") as stream:
        stream.write(b"new")
    assert os.readlink(tmp_path / "link") == "target"
    assert (tmp_path / "target").read_bytes() == b"new"


def test_a_place_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for place, said in [
        (tmp_path / "nowhere" / "x.csv", "No such file or directory"),
        (tmp_path / "file" / "x.csv", "Not a directory"),
        (tmp_path, "it is not a file"),
    ]:
        with pytest.raises(OutputError, match=said), replacing(place):
            pytest.fail("nothing can be written here")


def test_a_full_disk_is_said_and_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="No space left on device"):
        fail_half_way(tmp_path / "big.csv", OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))
    assert list(tmp_path.iterdir()) == []
