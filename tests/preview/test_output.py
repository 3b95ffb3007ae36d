"""Whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

import pytest

from teleop.preview.output import OutputError, replacing


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


def test_others_may_read_it_as_they_may_any_new_file(tmp_path: Path) -> None:
    with replacing(tmp_path / "made") as stream:
        stream.write(b"")
    (tmp_path / "plain").touch()
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("made", "plain")]
    assert modes[0] == modes[1]


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
        (Path("/dev/null"), "it is not a file"),
    ]:
        with pytest.raises(OutputError, match=said), replacing(place):
            pytest.fail("nothing can be written here")


def test_a_full_disk_is_said_and_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="No space left on device"):
        fail_half_way(tmp_path / "big.csv", OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))
    assert list(tmp_path.iterdir()) == []
