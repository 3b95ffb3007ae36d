"""The profile's `sticks` and `presets`: what stands there when nothing is written, and what is refused where."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile, load_profile
from teleop.config.resources import folder


def loaded(tmp_path: Path, text: str) -> Profile:
    (tmp_path / "rig.yaml").write_text((folder("profiles") / "sim.yaml").read_text() + text)
    return load_profile(str(tmp_path / "rig.yaml"))


def test_what_is_not_written_is_known_as_such() -> None:
    profile = load_profile("sim")
    assert (profile.sticks.dead_zone, profile.sticks.expo, profile.sticks.speed) == (None, None, 1.0)
    assert profile.sticks.ranges == [0.1, 0.35, 1.0]
    assert (profile.sticks.start_range, profile.sticks.ramp, profile.sticks.low_pass) == (1, 0.3, 0.05)
    assert profile.presets.recall == 3.0


@pytest.mark.parametrize(("written", "seconds"), [("2", 2.0), ("2.5", 2.5), ("4s", 4.0), ("1m30s", 90.0)])
def test_a_recall_takes_a_time_as_times_are_written(tmp_path: Path, written: str, seconds: float) -> None:
    assert loaded(tmp_path, f"presets: {{recall: {written}}}\n").presets.recall == seconds


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("sticks: {ranges: [0.5, 0.1]}", "sticks.ranges must rise, slowest first, not 0.5, 0.1"),
        ("sticks: {ranges: [0.5, 0.5]}", "sticks.ranges must rise, slowest first, not 0.5, 0.5"),
        ("sticks: {ranges: []}", "sticks.ranges must have at least 1"),
        ("sticks: {ranges: [0.5, 2]}", "sticks.ranges[1] must be at most 1"),
        ("sticks: {start_range: 4}", "sticks start_range must be 1..3, one of the ranges, not 4"),
        ("sticks: {start_range: 0}", "sticks.start_range must be at least 1"),
        ("sticks: {ramp: -1}", "sticks.ramp must be at least 0"),
        ("sticks: {low_pass: 3}", "sticks.low_pass must be at most 1"),
        ("presets: {recall: 0}", "presets.recall must be positive"),
        ("presets: {recall: soon}", "presets.recall must be a time"),
        ("presets: {recal: 3}", "presets: unknown key `recal`; did you mean `recall`?"),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(tmp_path: Path, text: str, problem: str) -> None:
    with pytest.raises(DocumentError) as caught:
        loaded(tmp_path, text + "\n")
    assert len(caught.value.problems) == 1
    assert problem in caught.value.problems[0]
