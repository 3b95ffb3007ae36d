"""What keyframes are fitted to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_takes import write_take

from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.planner import Key, plan
from teleop.recording.reader import read_take
from teleop.recording.to_keyframes.reference import GRID, Reference, references, too_fast
from teleop.recording.to_keyframes.rests import Span

LIMITS = Limits(-180, 180, 120, 240, 1200)
MOVE = plan({Axis.PAN: [Key(0, 0), Key(3, 40)]}, {Axis.PAN: LIMITS}).tracks[Axis.PAN]


def test_it_is_the_motion_at_every_place_and_twice_as_long_at_half_the_speed(tmp_path: Path) -> None:
    take = read_take(write_take(tmp_path / "t.mcap", {Axis.PAN: MOVE.at}, 4))
    found = references(take)[Axis.PAN]
    assert found.positions == pytest.approx(MOVE.sample(np.arange(401) / GRID)[0], abs=1e-6)
    assert found.rests[-1].end == 400
    assert len(references(take, 0.5)[Axis.PAN].positions) == 801


def test_what_was_never_measured_cannot_be_followed(tmp_path: Path) -> None:
    take = read_take(write_take(tmp_path / "t.mcap", {Axis.PAN: MOVE.at}, 1))
    with pytest.raises(UnplayableError, match="pan was never measured; leave out --measured"):
        references(take, measured=True)


def test_rests_give_way_where_they_are_long_enough_and_never_at_the_ends() -> None:
    reference = Reference(np.zeros(101), [Span(0, 20), Span(50, 55), Span(80, 100)], [])
    assert list(reference.slackened(4).rests) == [Span(0, 16), Span(50, 55), Span(84, 100)]


def test_corners_lie_inside_the_ends_of_a_long_even_way_and_in_the_middle_of_a_short_one() -> None:
    reference = Reference(np.zeros(101), [], [Span(10, 30), Span(50, 56)])
    assert list(reference.corners(0, 100)) == [13, 27, 53]
    assert list(reference.corners(20, 100)) == [27, 53]


@pytest.mark.parametrize(("speed", "ahead"), [(90.0, None), (130.0, 16.0), (-130.0, 16.0)])
def test_too_fast_is_what_gets_ahead_of_the_share_of_the_velocity(speed: float, ahead: float | None) -> None:
    reference = Reference(speed * np.arange(101) / GRID, [], [])
    found = too_fast(reference, LIMITS, 0.95, 0.2)
    assert found == (None if ahead is None else (1.0, pytest.approx(ahead)))
