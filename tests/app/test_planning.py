"""Plans from files, dicts and takes."""

from __future__ import annotations

import pytest

from teleop.app.planning import is_take, plan_content, plan_file
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.config.profile import load_profile

KEYS = [{"at": 0, "pan": 0}, {"at": 1, "pan": 20}]


@pytest.fixture
def profile():
    return load_profile("sim")


@pytest.mark.parametrize(("name", "take"), [("a.mcap", True), ("a.MCAP", True), ("a.yaml", False), ("reveal", False)])
def test_a_take_is_known_by_its_ending(name, take):
    assert is_take(name) is take


def test_a_timelapse_is_planned_with_its_rehearsal_and_its_own_warnings(profile):
    plan = plan_file("day-to-night", profile)
    assert plan.timelapse is not None
    assert plan.sequence.duration > 0
    assert plan.warnings is plan.timelapse.warnings


def test_a_share_of_the_limits_that_does_not_do_is_named(profile, tmp_path):
    file = tmp_path / "fast.yaml"
    file.write_text("keyframes: [{at: 0, pan: 0}, {at: 1, pan: 20}]\n")
    assert plan_file(str(file), profile).sequence.duration == pytest.approx(1)
    with pytest.raises(UnplayableError) as error:
        plan_file(str(file), profile, share=0.5)
    assert error.value.problems[-1] == f"{file}: was planned with 50% of the rig's limits"


def test_a_dict_has_no_lines_in_its_errors(profile):
    with pytest.raises(DocumentError) as error:
        plan_content({"keyframes": [*KEYS, {"at": 9, "pen": 1}]}, profile)
    assert all(problem.startswith("sequence: ") for problem in error.value.problems)


def test_the_files_that_a_dict_names_are_in_the_current_folder(profile, tmp_path, monkeypatch):
    (tmp_path / "track.csv").write_text("".join(f"{frame / 10}\n" for frame in range(48)), encoding="utf-8")
    (tmp_path / "in.yaml").write_text("keyframes: [{at: 0, pan: 0}, {at: 2, pan: 10}]\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    table = plan_content({"source": {"file": "track.csv", "fps": 24, "columns": {"pan": 1}}}, profile)
    assert table.sequence.move.duration > 47 / 24
    included = plan_content({"include": [{"move": "in.yaml", "at": 0}]}, profile)
    assert included.sequence.move.duration == pytest.approx(2)
    with pytest.raises(DocumentError, match="no such file"):
        plan_content({"source": {"file": "other.csv", "fps": 24, "columns": {"pan": 1}}}, profile)


def test_a_drones_move_is_known(profile):
    flown = [{"at": 0, "stick_yaw": 0}, {"at": 2, "stick_yaw": 0}]
    assert plan_content({"keyframes": flown}, load_profile("m100")).is_flown
    assert not plan_content({"keyframes": KEYS}, profile).is_flown
