"""Keyframes that aim: the target stays in sight while the base moves, and every error has its place.

The geometry is worked out anew from the finished move: a pan says where on its line the base is, and then the tilt
has to fit that place.
"""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from sequences import LIMITS, load, problems_of
from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis, Limits
from teleop.sequence.compile import CompiledSequence, load_sequence
from teleop.timelapse.compile import load_timelapse

HEAD = "targets: {door: [4.0, 3.0, 1.6], vase: [0, 3, 1.0]}\nmount: {height: 1.6}\nkeyframes:\n"
SLIDE = "- {at: 0, aim: vase, base: [-1, 0, 0]}\n- {at: 10s, aim: vase, base: [1, 0, 0]}\n"


def angles(move: CompiledSequence, time: float) -> tuple[float, float]:
    state = move.move.at(time)
    return state[Axis.PAN].position, state[Axis.TILT].position


def test_a_target_by_name_and_a_point_give_pan_and_tilt(tmp_path: Path) -> None:
    move = load(tmp_path, HEAD + "- {at: 0, aim: door}\n- {at: 4s, aim: [-4, 3, 6.6], focus: 1}\n")
    assert angles(move, 0) == pytest.approx((math.degrees(math.atan2(4, 3)), 0))
    assert angles(move, 4) == pytest.approx((math.degrees(math.atan2(-4, 3)), 45))
    assert move.move.at(4)[Axis.FOCUS].position == 1


@pytest.mark.parametrize("mount", ["mount: 1.6", "mount: {height: 1.6}"])
def test_the_height_of_the_camera_counts(tmp_path: Path, mount: str) -> None:
    move = load(tmp_path, f"{mount}\nkeyframes:\n- {{at: 0, aim: [0, 2, 3.6]}}\n- {{at: 9s, aim: [0, 2, 0]}}\n")
    assert angles(move, 0)[1] == pytest.approx(45)
    assert angles(move, 9)[1] == pytest.approx(math.degrees(math.atan2(-1.6, 2)))


def test_an_offset_looks_beside_the_target(tmp_path: Path) -> None:
    move = load(
        tmp_path, HEAD + "- {at: 0, pan: 0, tilt: 0}\n- {at: 5s, aim: [0, 3, 1.6], offset: {pan: 2, tilt: -1}}\n"
    )
    assert angles(move, 5) == pytest.approx((2, -1))


@settings(max_examples=20)
@given(
    st.tuples(st.floats(-3, 3), st.floats(2, 8), st.floats(-1, 3)),
    st.tuples(st.floats(-1.5, 1.5), st.floats(-1, 1), st.floats(-0.5, 0.5)),
    st.tuples(st.floats(-1.5, 1.5), st.floats(-1, 1), st.floats(-0.5, 0.5)),
    st.sampled_from(["", ", ease: 1s"]),
)
def test_a_target_stays_in_sight_while_the_base_moves(
    tmp_path_factory: pytest.TempPathFactory,
    target: tuple[float, ...],
    first: tuple[float, ...],
    last: tuple[float, ...],
    ease: str,
) -> None:
    across, forward = last[0] - first[0], last[1] - first[1]
    assume(math.hypot(across, forward) > 0.2)
    text = (
        f"targets: {{it: {[*target]}}}\nmount: 0.3\nkeyframes:\n"
        f"- {{at: 0, aim: it, base: {[*first]}{ease}}}\n- {{at: 8s, aim: it, base: {[*last]}{ease}}}\n"
    )
    move = load(tmp_path_factory.mktemp("aim"), text)
    for tenth in range(81):
        pan, tilt = angles(move, tenth / 10)
        share = _share_of(target, first, last, pan)
        if share is None:  # seen along its own line, the base could be anywhere on it
            continue
        camera = [a + share * (b - a) for a, b in zip(first, last, strict=True)]
        right, ahead, up = (to - at for to, at in zip(target, camera, strict=True))
        assert tilt == pytest.approx(math.degrees(math.atan2(up - 0.3, math.hypot(right, ahead))), abs=0.1)


def _share_of(target: tuple[float, ...], first: tuple[float, ...], last: tuple[float, ...], pan: float) -> float | None:
    """How far along its line a base is that has the target at this pan; None where the pan says too little."""
    sin, cos = math.sin(math.radians(pan)), math.cos(math.radians(pan))
    changes = (last[0] - first[0]) * cos - (last[1] - first[1]) * sin
    if abs(changes) < 0.2:
        return None
    return ((target[0] - first[0]) * cos - (target[1] - first[1]) * sin) / changes


def test_the_base_moves_as_an_axis_would_and_rests_at_both_ends(tmp_path: Path) -> None:
    move = load(tmp_path, HEAD + SLIDE)
    assert angles(move, 5) == pytest.approx((0, math.degrees(math.atan2(-0.6, 3))), abs=0.01)
    places = [3 * math.tan(math.radians(-angles(move, 10 * share)[0])) for share in (0.25, 0.75)]
    smooth = [10 * u**3 - 15 * u**4 + 6 * u**5 for u in (0.25, 0.75)]  # from rest to rest with the least jerk
    assert [(place + 1) / 2 for place in places] == pytest.approx(smooth, abs=0.01)
    assert move.move.at(0)[Axis.PAN].velocity == move.move.at(10)[Axis.PAN].velocity == 0


def test_with_an_ease_the_base_runs_evenly_between_its_ramps(tmp_path: Path) -> None:
    move = load(
        tmp_path, HEAD + "- {at: 0, aim: vase, base: [-1, 0, 0], ease: 1s}\n- {at: 9s, aim: vase, base: [1, 0, 0]}\n"
    )
    places = [3 * math.tan(math.radians(-angles(move, time)[0])) for time in (2, 4, 6)]
    assert places[1] - places[0] == pytest.approx(2 * 2 / 8, rel=0.03)
    assert places[2] - places[1] == pytest.approx(2 * 2 / 8, rel=0.03)


def test_the_camera_may_come_from_elsewhere_and_go_on(tmp_path: Path) -> None:
    move = load(
        tmp_path,
        HEAD
        + "- {at: 0, pan: 60, tilt: 5, base: [-1, 0, 0]}\n- {at: 3s, aim: vase}\n"
        + "- {at: 8s, aim: vase, base: [1, 0, 0]}\n- {at: 11s, aim: door}\n",
    )
    assert angles(move, 11) == pytest.approx((45, 0))
    assert move.key_times == [0, 3, 8, 11]


def test_a_hold_keeps_the_target_in_sight_too(tmp_path: Path) -> None:
    text = (
        "- {at: 0, aim: vase, hold: 6s}\n- {at: 1s, base: [0, 0, 0]}\n- {at: 5s, base: [1, 0, 0]}\n- {at: 9s, pan: 0}\n"
    )
    move = load(tmp_path, HEAD + text)
    assert angles(move, 5) == pytest.approx((math.degrees(math.atan2(-1, 3)), -10.75), abs=0.1)
    assert angles(move, 6) == pytest.approx(angles(move, 5), abs=0.01)


def test_an_included_file_keeps_its_targets(tmp_path: Path) -> None:
    (tmp_path / "slide.yaml").write_text(HEAD + SLIDE)
    move = load(tmp_path, "include: [{move: slide.yaml, at: 1s, speed: 50%}]\n")
    assert angles(move, 11) == pytest.approx((0, math.degrees(math.atan2(-0.6, 3))), abs=0.01)


def test_a_target_behind_the_rig_is_followed_through_the_seam(tmp_path: Path) -> None:
    text = "keyframes:\n- {at: 0, aim: [-1, -3, 0], base: [-2, 0, 0]}\n- {at: 9s, aim: [-1, -3, 0], base: [2, 0, 0]}\n"
    file = tmp_path / "behind.yaml"
    file.write_text(text)
    move = load_sequence(str(file), {**LIMITS, Axis.PAN: Limits(-math.inf, math.inf, 100, 200, 1000)}, "the rig")
    pans = [angles(move, time / 10)[0] for time in range(91)]
    assert max(pans) - min(pans) < 90


def test_a_timelapse_aims_at_its_frames(tmp_path: Path) -> None:
    (tmp_path / "lapse.yaml").write_text(
        "timelapse: {frames: 50, interval: 3s, exposure: 0.5s}\n"
        + HEAD.replace("keyframes:\n", "")
        + "keyframes:\n- {at: 0, aim: vase, base: [-1, 0, 0]}\n- {at: 49, aim: vase, base: [1, 0, 0]}\n"
    )
    lapse = load_timelapse(str(tmp_path / "lapse.yaml"), LIMITS, "the rig")
    assert lapse is not None
    pan = [key.position for key in lapse.keys[Axis.PAN]]
    assert (pan[0], pan[-1]) == pytest.approx((math.degrees(math.atan2(1, 3)), math.degrees(math.atan2(-1, 3))))


@pytest.mark.parametrize(
    ("frame", "place", "text"),
    [
        (
            "{at: 1, aim: dor}",
            "4:16",
            "key 1: aim: unknown target 'dor'; did you mean door?",
        ),
        ("{at: 1, aim: [1, 2]}", "4:16", "key 1: aim must be [x, y, z] in meters, not [1, 2]"),
        ("{at: 1, aim: 3}", "4:16", "key 1: aim must be the name of a target or [x, y, z] in meters, not 3"),
        (
            "{at: 1, aim: door, pan: 3}",
            "4:27",
            "key 1: pan is given by aim: remove one; `offset` looks beside",
        ),
        ("{at: 1, pan: 3, offset: {pan: 1}}", "4:27", "key 1: offset needs an aim"),
        ("{at: 1, aim: [0, 0, 1.6]}", "4:16", "key 1: aim: the target is where the camera is"),
        ("{at: 1, aim: [.nan, 0, 1]}", "4:16", "key 1: aim must be [x, y, z] in meters, not [nan, 0, 1]"),
        ("{at: 1, aim: [1.0e9, 0, 1]}", "4:16", "key 1: aim must be [x, y, z] in meters, not [1000000000.0, 0, 1]"),
    ],
)
def test_what_cannot_be_aimed_at_is_an_error_with_its_place(tmp_path: Path, frame: str, place: str, text: str) -> None:
    problems = problems_of(tmp_path, f"{HEAD}- {frame}\n")
    assert [problem.partition("shoot.yaml:")[2] for problem in problems] == [f"{place}: {text}"]


def test_ramps_of_the_base_that_have_no_time_are_an_error(tmp_path: Path) -> None:
    text = "- {at: 0, aim: vase, base: [-1, 0, 0], ease: 9s}\n- {at: 10s, aim: vase, base: [1, 0, 0]}\n"
    (problem,) = problems_of(tmp_path, HEAD + text)
    assert "the base has no time for its ramps from key 1 to key 2: use a shorter `ease`" in problem


def test_a_target_that_the_rig_cannot_follow_is_an_error_at_its_key(tmp_path: Path) -> None:
    text = "keyframes:\n- {at: 0, aim: [0, 0.1, 0], base: [-9, 0, 0]}\n- {at: 3s, aim: [0, 0.1, 0], base: [9, 0, 0]}\n"
    assert problems_of(tmp_path, text, UnplayableError) == [
        "shoot.yaml:2:3: pan cannot keep the target in sight: the base is too fast there; use more time"
    ]


def test_what_follows_is_as_smooth_as_the_base_below_it(tmp_path: Path) -> None:
    peaks = load(tmp_path, HEAD + SLIDE).move.peaks()[Axis.PAN]
    assert peaks.jerk < 20  # deg/s3, of 1200; to pass the keys on the way evenly would take most of that
