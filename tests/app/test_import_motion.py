"""A path of frames becomes keys whose plan is within the tolerance of every frame, or a line that says why not."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.app.export_motion import planned_motion
from teleop.app.import_motion import Imported, Importer
from teleop.app.planning import plan_content, plan_file
from teleop.config.documents.document import UnplayableError
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.interchange.motion import Motion, TimedCue

SIM = load_profile("sim")
PAN, TILT, FOCUS = Axis.PAN, Axis.TILT, Axis.FOCUS
RATE = Fraction(24)


def imported(motion: Motion, tolerance: float = 0.1, *, stretch: bool = False) -> Imported:
    return Importer("shot", SIM.limits, "sim", tolerance, stretch).sequence(motion, ["made by hand"])


def frames(positions: Mapping[Axis, np.ndarray], rate: Fraction | None = RATE, first: int = 1) -> Motion:
    count = len(next(iter(positions.values())))
    return Motion("shot", np.arange(count) / float(rate or 24), positions, rate, first)


def off(found: Imported, motion: Motion, begin: float = 0.0) -> float:
    """The most that the new sequence is off any frame, in degrees."""
    return max(
        float(np.abs(found.sequence.move.tracks[axis].sample(begin + motion.times)[0] - column).max())
        for axis, column in motion.positions.items()
        if axis.is_angle
    )


@pytest.mark.parametrize("name", ["reveal", "montage", "whip-pan"])
@pytest.mark.parametrize("rate", [RATE, Fraction(24000, 1001)])
def test_the_shipped_moves_come_back_within_the_tolerance(name: str, rate: Fraction) -> None:
    motion = planned_motion(plan_file(name, SIM), name, rate)
    found = imported(motion)
    assert off(found, motion) <= 0.1
    assert all(deviation.size <= (0.1 if axis.is_angle else 0.001) for axis, deviation in found.deviations.items())
    assert found.keyframes < len(motion.times) / 4


def test_a_dwell_comes_back_as_a_hold_and_a_wait_in_it_is_accepted() -> None:
    keys = [{"at": 0, "pan": 0, "tilt": 0}, {"at": 3, "pan": 20, "tilt": 5, "hold": 2}, {"at": 9, "pan": 60, "tilt": 0}]
    cues = [{"at": 4, "wait": "operator"}, {"at": 9, "camera": "stop"}]
    motion = planned_motion(plan_content({"keyframes": keys, "cues": cues}, SIM), "a", RATE)
    found = imported(motion)
    assert [cue.name for cue in found.sequence.cues] == ["wait", "stop"]
    assert [cue.at for cue in found.sequence.cues] == [4, 9]
    held = [line for line in yaml.safe_load(found.text)["keyframes"] if "hold" in line]
    assert held == [{"at": "72f", "pan": 20, "tilt": 5, "hold": "48f"}]


def test_a_path_that_begins_and_ends_at_speed_has_a_run_up_and_cues_move_with_it() -> None:
    motion = frames({PAN: np.linspace(-20, 20, 97), TILT: np.zeros(97)})
    motion = Motion("shot", motion.times, motion.positions, RATE, 1001, [TimedCue(0.0, {"camera": "record"})])
    found = imported(motion)
    begin = found.sequence.cues[0].at
    assert begin > 0
    assert off(found, motion, begin) <= 0.1
    assert found.remarks == [f"it begins {begin:.2f} s before the file's first frame, to be at speed there"]
    assert "# The file's first frame is at" in found.text


def test_what_is_too_fast_is_refused_with_the_frame_and_the_cure_and_stretched_when_asked() -> None:
    motion = frames({PAN: 60 * np.sin(np.arange(97) / 6)}, first=1001)
    with pytest.raises(UnplayableError) as refused:
        imported(motion)
    text = str(refused.value)
    assert text.startswith("shot: pan is too fast for sim (its ")
    assert " at frame 1" in text
    assert "--rate" in text
    assert "--stretch" in text
    found = imported(motion, stretch=True)
    assert any(remark.startswith("stretched ") for remark in found.remarks)
    assert found.sequence.duration > 97 / 24


def test_what_leaves_the_soft_limits_is_refused_with_its_line() -> None:
    motion = frames({TILT: np.linspace(0, 200, 200)})
    motion = Motion("shot", motion.times, motion.positions, RATE, 1, lines=range(3, 203))
    with pytest.raises(UnplayableError, match=r"^shot:202: frame 200: tilt must be within .* \(sim\), not 200$"):
        imported(motion)


def test_an_axis_that_the_rig_does_not_have_is_named_with_the_option_that_leaves_it_out() -> None:
    motion = frames({PAN: np.zeros(9), Axis.STICK_YAW: np.zeros(9)})
    with pytest.raises(UnplayableError, match=r"moves stick_yaw, but sim has only .*: give --only .*--only pan$"):
        imported(motion)


def test_angles_go_on_over_the_seam_and_into_the_turn_of_the_limits() -> None:
    smooth = 10 * np.sin(np.linspace(0, np.pi, 97)) ** 2
    wrapped = (smooth + 355) % 360  # from 355 over 360 to 5 and back
    found = imported(frames({TILT: smooth - 360.0, PAN: wrapped}))
    assert off(found, frames({TILT: smooth})) <= 0.1
    pan = found.sequence.move.tracks[PAN].sample(np.arange(97) / 24)[0]
    assert np.abs(np.diff(pan)).max() < 1


def test_frames_that_are_missing_are_any() -> None:
    whole = frames({PAN: 5 * np.sin(np.linspace(0, 3, 97))})
    kept = np.delete(np.arange(97), [10, 11, 40])
    found = imported(Motion("shot", whole.times[kept], {PAN: whole.positions[PAN][kept]}, RATE))
    assert off(found, whole, max(0.0, found.sequence.duration - 0)) >= 0  # it has a plan
    assert found.deviations[PAN].size <= 0.1


def test_readings_without_a_rate_become_a_sequence_in_seconds() -> None:
    times = np.arange(100) * 0.04 + 0.002 * np.sin(np.arange(100))
    path = 10 * np.sin(np.clip(times, 0, 3) / 3 * np.pi / 2) ** 2
    found = imported(Motion("take", times - times[0], {PAN: path}, None))
    content = yaml.safe_load(found.text)
    assert "fps" not in content
    assert found.sequence.duration == pytest.approx(times[-1] - times[0], abs=0.5)
    assert off(found, Motion("", times - times[0], {PAN: path})) <= 0.11


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_path_of_few_frames_or_at_rest_is_a_move(count: int) -> None:
    found = imported(frames({PAN: np.full(count, 12.5)}))
    assert found.sequence.move.tracks[PAN].end == 12.5


def test_a_rest_is_held_as_long_as_the_file_is() -> None:
    found = imported(frames({PAN: np.full(97, 3.0), TILT: np.full(97, -3.0)}))
    assert found.sequence.duration == pytest.approx(4.0)
    assert found.keyframes == 1


def test_cues_alone_have_a_placeholder_and_say_so() -> None:
    cues = [TimedCue(1.0, {"camera": "record"}), TimedCue(2.5, {"camera": "stop"})]
    found = imported(Motion("edit", np.zeros(1), {}, RATE, cues=cues))
    assert [(cue.at, cue.name) for cue in found.sequence.cues] == [(1, "record"), (2.5, "stop")]
    assert "placeholder" in found.remarks[0]


def test_a_sequence_of_fractional_rate_is_exact() -> None:
    motion = planned_motion(plan_file("nudge", SIM), "nudge", Fraction(30000, 1001))
    found = imported(motion)
    assert found.sequence.fps == 30000 / 1001
    assert yaml.safe_load(found.text)["fps"] == 29.97


@settings(max_examples=10, deadline=None)
@given(st.lists(st.floats(-20, 20), min_size=2, max_size=4), st.sampled_from([24, 25, Fraction(24000, 1001)]))
def test_any_move_of_ours_comes_back(keys: list[float], rate: Fraction) -> None:
    content = {"keyframes": [{"at": 3 * index, "pan": round(key, 2)} for index, key in enumerate(keys)]}
    motion = planned_motion(plan_content({**content, "fit": "stretch"}, SIM), "a", Fraction(rate))
    assert off(imported(motion), motion) <= 0.1
