"""A panorama: every frame is covered, neighbours share enough, the way is a serpentine, and its errors have places."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequences import load, problems_of
from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.sequence.panorama import centers, grid

TEXT = "panorama:\n  fov: [54, 38]\n  overlap: 30%\n  pan: [-90, 90]\n  tilt: [30, -30]\n  every: 3s\n"


@given(st.floats(-170, 170), st.floats(-170, 170), st.floats(5, 120), st.floats(0, 0.9))
def test_all_is_seen_and_neighbours_share_what_was_asked_for(
    first: float, last: float, fov: float, overlap: float
) -> None:
    aims = centers(first, last, fov, overlap)
    low, high = sorted((first, last))
    assert min(aims) - fov / 2 <= low + 1e-6
    assert max(aims) + fov / 2 >= high - 1e-6
    if len(aims) > 1:
        assert min(aims) - fov / 2 == pytest.approx(low, abs=1e-6)  # and nothing beyond the edges
        assert max(aims) + fov / 2 == pytest.approx(high, abs=1e-6)
        assert all(abs(b - a) <= fov * (1 - overlap) + 1e-6 for a, b in pairwise(aims))
        fewer = (high - low - fov) / (len(aims) - 2) if len(aims) > 2 else high - low
        assert fewer > fov * (1 - overlap) - 1e-6  # one frame less would not do
    assert (aims[-1] - aims[0]) * (last - first) >= 0


def test_a_whole_circle_closes_with_the_overlap_of_all_others() -> None:
    aims = grid([60, 40], 0.3, [-180, 180], [0, 0]).pans
    assert len(aims) == 9
    steps = [b - a for a, b in pairwise([*aims, aims[0] + 360])]
    assert steps == pytest.approx([40] * 9)


def test_the_way_is_a_serpentine_that_stands_still_at_each_shutter(tmp_path: Path) -> None:
    performance = load(tmp_path, TEXT + "  settle: 0.7s\n  exposure: 0.8s\n  at: 1s\n")
    move = performance.move
    cues = performance.cues
    assert [cue.action for cue in cues] == [Action.SHUTTER] * 10
    assert [cue.at for cue in cues] == pytest.approx([1.7 + 3 * index for index in range(10)])
    aimed = [tuple(round(state.position, 6) for state in move.at(cue.at).values()) for cue in cues]
    pans = [-63, -31.5, 0, 31.5, 63]
    assert aimed == [*((pan, 11) for pan in pans), *((pan, -11) for pan in reversed(pans))]
    for cue in cues:
        for time in (cue.at - 0.69, cue.at, cue.at + 0.79):
            assert all(state[1:] == (0, 0) for state in move.at(time).values())
    assert all(sum(a != b for a, b in zip(here, there, strict=True)) == 1 for here, there in pairwise(aimed))


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("fov: [54, 38]", "fov: [54, 0]", "2:13: panorama.fov[1] must be positive"),
        ("fov: [54, 38]", "fov: 54", "2:8: panorama.fov must be a list, not 54"),
        ("fov: [54, 38]", "fov: [54]", "2:8: panorama.fov must have at least 2"),
        ("30%", "30", "3:12: panorama.overlap must be a percentage (30%), not 30"),
        ("30%", "95%", "3:12: panorama.overlap must be at most 90%"),
        ("3s", "1s", "6:10: panorama.every must be longer than settle and exposure (1 s), or there is no time to move"),
        ("3s", "x", "6:10: panorama.every must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not 'x'"),
        ("[-90, 90]", "[-200, 200]", "4:8: panorama.pan must be at most 360 deg from edge to edge"),
        ("fov: [54, 38]", "fov: [0.1, 0.1]", "2:3: panorama would be"),
        ("every: 3s", "evry: 3s", "6:3: panorama: unknown key `evry`; did you mean `every`?"),
    ],
)
def test_what_is_wrong_is_said_at_its_place(tmp_path: Path, old: str, new: str, problem: str) -> None:
    found = problems_of(tmp_path, TEXT.replace(old, new))
    assert [line for line in found if line.startswith(f"shoot.yaml:{problem}")], found


def test_what_the_rig_cannot_reach_is_said_in_its_words(tmp_path: Path) -> None:
    text = TEXT.replace("[30, -30]", "[-10, -90]")
    assert problems_of(tmp_path, text, UnplayableError) == [
        "shoot.yaml:5:9: panorama.tilt aims from -71 to -29, and the rig has -56..146"
    ]
    found = problems_of(tmp_path, TEXT.replace("3s", "1.1s"), UnplayableError)
    assert found[0].startswith("shoot.yaml:6:10: panorama.every must be at least 1.98")
    [found] = problems_of(tmp_path, TEXT, UnplayableError, devices=["gimbal"])
    assert found == "shoot.yaml:2:3: panorama: the rig has no camera; its sinks are gimbal"


def test_keyframes_stand_beside_it_but_not_in_its_way(tmp_path: Path) -> None:
    beside = TEXT + "keyframes:\n  - {at: 0, focus: 0.2}\n  - {at: 20, focus: 0.8}\n  - {at: 32, pan: 0}\n"
    move = load(tmp_path, beside).move
    assert set(move.tracks) == {Axis.PAN, Axis.TILT, Axis.FOCUS}
    assert move.end[Axis.PAN].position == 0
    [found] = problems_of(tmp_path, beside.replace("at: 32", "at: 25"))
    assert found == "shoot.yaml:10:5: key 3 must begin after panorama ends (pan, 28 s)"


def test_a_panorama_is_no_timelapse(tmp_path: Path) -> None:
    found = problems_of(tmp_path, TEXT + "timelapse: {frames: 10, interval: 2s, exposure: 0.1s}\n")
    assert "shoot.yaml:2:3: panorama cannot be used with timelapse: it has frames of its own" in found
