"""Keys and cues on one clock: blocks in order, and an included file at its time and speed."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequences import LIMITS
from teleop.config.documents.yaml_loader import read_document
from teleop.core.axes import Axis
from teleop.planner.keyframes.keys import Key
from teleop.sequence.model import SequenceModel
from teleop.sequence.timeline import Block, Origin, Timeline, expand, joined

TEXT = "keyframes:\n- {at: 0, pan: 0}\n- {at: 2, pan: 10}\n- {at: 4, pan: 20}\ncues:\n- {at: 1, camera: shutter}\n"


@pytest.fixture
def timeline(tmp_path: Path) -> Timeline:
    (tmp_path / "shoot.yaml").write_text(TEXT)
    document = read_document(tmp_path / "shoot.yaml", "shoot.yaml")
    timeline = Timeline.of(document, SequenceModel.model_validate(document.data))
    timeline.keys, _ = joined(timeline.own_blocks(LIMITS))
    return timeline


def test_an_included_file_is_moved_and_played_faster_as_a_whole(timeline: Timeline) -> None:
    inserted = timeline.inserted_at(10.0, 2.0, "include 1")
    assert [(key.at, key.position) for key in inserted.keys[Axis.PAN]] == [(10, 0), (11, 10), (12, 20)]
    assert [timed.cue.at for timed in inserted.cues] == [10.5]
    assert [key.stop for key in inserted.keys[Axis.PAN]] == [True, False, True], "its ends stay stops"
    assert "include 1, key 2" in inserted.places


def test_more_keys_than_can_be_planned_are_refused(timeline: Timeline) -> None:
    assert list(expand(timeline, LIMITS)) == []
    timeline.keys = {Axis.PAN: [Key(at, 0.0) for at in range(10_001)]}
    assert list(expand(timeline, LIMITS)) == ["shoot.yaml:1:1: needs 10001 keys of pan; the maximum is 10000"]


@given(st.lists(st.tuples(st.integers(0, 100), st.integers(1, 10)), min_size=1, max_size=8))
def test_blocks_come_in_order_of_time_and_are_refused_where_they_overlap(spans: list[tuple[int, int]]) -> None:
    origin = Origin(read_document(Path("sequences/reveal.yaml"), "reveal.yaml"), ("keyframes",))
    blocks = [
        Block([Key(float(at), float(index)), Key(float(at + length), float(index))], f"block {index}", origin)
        for index, (at, length) in enumerate(spans)
    ]
    keys, problems = joined({Axis.PAN: blocks})
    times = [key.at for key in keys[Axis.PAN]]
    in_order = sorted(spans)
    overlap = any(after[0] <= before[0] + before[1] for before, after in pairwise(in_order))
    assert bool(problems) == overlap
    assert overlap or times == sorted(times)
