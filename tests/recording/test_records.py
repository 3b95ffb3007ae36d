"""The records of a file cut anywhere: whole ones only, in order, and never an exception of another kind."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import at_rest, write_take

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.recording.records import Progress, whole_records


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_take(tmp_path_factory.mktemp("take") / "t.mcap", {Axis.PAN: at_rest(1)}, 2)


def kinds(path: Path, progress: Progress) -> list[str]:
    return [type(record).__name__ for record in whole_records(path, progress)]


def test_a_whole_file_is_closed(take: Path) -> None:
    progress = Progress()
    assert kinds(take, progress).count("Message") > 200
    assert progress == Progress(take.stat().st_size, take.stat().st_size, closed=True)


@settings(max_examples=40, deadline=None)
@given(share=st.floats(0, 0.999))
def test_a_cut_file_is_read_as_far_as_it_is_whole(take: Path, share: float) -> None:
    data, whole = take.read_bytes(), kinds(take, Progress())
    cut = take.with_name("cut.mcap")
    cut.write_bytes(data[: int(share * len(data))])
    progress = Progress()
    found: list[str] = []
    with suppress(DocumentError):
        found = kinds(cut, progress)
    assert found or progress.whole == 0
    assert found == whole[: len(found)]
    assert not progress.closed
    assert progress.whole <= progress.size == cut.stat().st_size


def test_nothing_behind_damage_is_used(take: Path) -> None:
    data = bytearray(take.read_bytes())
    data[len(data) // 3] ^= 0xFF
    damaged = take.with_name("damaged.mcap")
    damaged.write_bytes(data)
    progress = Progress()
    assert len(kinds(damaged, progress)) < len(kinds(take, Progress()))
    assert progress.whole < progress.size
