"""Timelapse files: every error at its line, and what a right one compiles to."""

from pathlib import Path

import numpy as np
import pytest

from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.core.axes import Axis, Limits
from teleop.timelapse.compile import Timelapse, load_timelapse
from teleop.timelapse.schedule import Schedule

LIMITS = {
    Axis.PAN: Limits(-180, 180, 120, 240, 1200),
    Axis.TILT: Limits(-56, 146, 90, 180, 900),
    Axis.FOCUS: Limits(0, 1, 0.5, 2, 10),
}
FILE = """
title: Dusk
fps: 24
keyframes:
  - {at: 0,    pan: -30, tilt: -5}
  - {at: 240f, pan: 20}
  - {at: 719,  pan: 60,  tilt: 10}
timelapse:
  frames: 720
  interval: 5s
  exposure: 0.5s
"""


def load(folder: Path, **changes: str) -> Timelapse:
    """FILE with lines below `timelapse:` changed, or added."""
    text = FILE
    for key, value in changes.items():
        line = next((each for each in text.splitlines() if each.startswith(f"  {key}:")), None)
        new = f"  {key}: {value}"
        text = text + new + "\n" if line is None else text.replace(line, new)
    return load_text(folder, text)


def load_text(folder: Path, text: str) -> Timelapse:
    (folder / "dusk.yaml").write_text(text)
    found = load_timelapse(str(folder / "dusk.yaml"), LIMITS, "the rig")
    assert found is not None
    return found


def problems(folder: Path, **changes: str) -> list[str]:
    with pytest.raises(DocumentError) as caught:
        load(folder, **changes)
    return [problem.removeprefix(f"{folder}/") for problem in caught.value.problems]


def test_the_path_goes_through_its_keys_at_their_frames(tmp_path: Path) -> None:
    found = load(tmp_path, lead_in="10", lead_out="20")
    assert found.frames == 750
    assert found.clip == pytest.approx(750 / 24)
    positions = found.path.positions(750)
    assert positions[Axis.PAN][[10, 250, 729]] == pytest.approx([-30, 20, 60], abs=1e-6)
    assert set(positions[Axis.PAN][:11]) == {-30}
    assert set(positions[Axis.PAN][729:]) == {60}
    assert np.all(np.diff(positions[Axis.TILT]) >= 0)
    assert found.path.at(250)[Axis.PAN] == pytest.approx(20, abs=1e-6)


def test_frames_are_due_by_formula() -> None:
    even = Schedule(5.0, 5.0, 720)
    assert [even.at(frame) for frame in (0, 1, 719)] == [0, 5, 3595]
    ramped = Schedule(2.0, 12.0, 720)
    due = [ramped.at(frame) for frame in range(720)]
    assert np.diff(due) == pytest.approx(np.linspace(2, 12, 719))
    assert [ramped.interval(frame) for frame in (0, 718)] == pytest.approx([2, 12])
    assert Schedule(3.0, 3.0, 1).at(0) == 0


@pytest.mark.parametrize("interval", ["5s", "{from: 2s, to: 12s}"])
def test_a_continuous_move_is_at_each_frame_when_it_is_due(tmp_path: Path, interval: str) -> None:
    found = load(tmp_path, interval=interval, mode="continuous", lead_in="5")
    move = found.path.on(found.slots)
    due = np.array([found.slots.at(frame) for frame in range(found.frames)])
    for axis, positions in found.path.positions(found.frames).items():
        position, velocity, acceleration, _ = move.sample(due)[axis]
        assert position == pytest.approx(positions, abs=1e-9)
        assert np.abs(np.diff(velocity)).max() < 0.02
        assert np.abs(acceleration).max() < 0.01
    assert move.duration == pytest.approx(found.slots.at(724))


BAD = [
    ("frames", "0", "9:11: timelapse.frames must be at least 1"),
    ("frames", "700", "7:10: key 3: at must be at most 699, the last of 700 frames counted from 0, not 719"),
    ("interval", "soon", "10:13: timelapse.interval must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not 'soon'"),
    ("interval", "0", "10:13: timelapse.interval must be more than 0 s"),
    ("interval", "{from: 2s}", "10:13: timelapse.interval.to is missing"),
    ("interval", "{from: 2s, to: 3s, by: 1}", "10:36: timelapse.interval.by: unknown key; the keys are from and to"),
    ("settle", "{below: 0, at_most: 1}", "12:19: timelapse.settle.below must be a rate above 0 deg/s, not 0"),
    ("settle", "{below: 1, at_most: x}", "12:31: timelapse.settle.at_most must be a time"),
    ("mode", "shoot", "12:9: timelapse.mode must be one of shoot-move-shoot, continuous, not 'shoot'"),
    ("exposur", "1", "12:3: timelapse: unknown key `exposur`; did you mean `exposure`?"),
    ("lead_in", "-1", "12:12: timelapse.lead_in must be at least 0"),
    ("delay", "-2", "12:10: timelapse.delay must be 0 s or later"),
]


@pytest.mark.parametrize(("key", "value", "said"), BAD)
def test_a_bad_section_says_where_and_what(tmp_path: Path, key: str, value: str, said: str) -> None:
    [line] = problems(tmp_path, **{key: value})
    assert line.startswith(f"dusk.yaml:{said}"), line


def test_all_errors_come_at_once(tmp_path: Path) -> None:
    assert len(problems(tmp_path, frames="700", interval="soon", mode="shoot", delay="-2")) == 4


def test_what_only_a_film_has_is_refused_and_times_are_frames(tmp_path: Path) -> None:
    text = FILE.replace("at: 240f", "at: 4s, ease: 2s").replace("fps: 24", "fps: 24\nease: {arrive: 1s, leave: 24f}")
    with pytest.raises(DocumentError) as caught:
        load_text(tmp_path, text + "repeat: {times: 2, mode: bounce}\ncues: [{at: 0, camera: record}]\n")
    said = "\n".join(problem.partition("dusk.yaml:")[2] for problem in caught.value.problems)
    assert "4:16: ease.arrive must be in output frames here (24f), or a share or a name, not '1s'" in said
    assert "7:10: key 2: at must be in output frames (240 or 240f), not '4s'" in said
    assert "7:20: key 2: ease must be in output frames" in said
    assert "repeat cannot be used with timelapse: its frames are counted once" in said
    assert "cues cannot be used with timelapse: the shutter is its only cue" in said


def test_keys_out_of_order_are_said_in_frames(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match=r"key 2: at must be after key 1 \(frame 300\)"):
        load_text(tmp_path, FILE.replace("at: 0, ", "at: 300, "))


def test_an_interval_that_cannot_hold_a_frame_says_which_and_what_would_do(tmp_path: Path) -> None:
    with pytest.raises(UnplayableError):
        load(tmp_path, interval="0.9s")
    [said] = problems(tmp_path, interval="0.9s")
    assert said == (
        "dusk.yaml:10:13: timelapse.interval must be at least 1.07 s, not 0.9 s: "
        "frame 80 of 720 takes exposure 0.5 s + move 0.262 s + settle 0.3 s"
    )
    [tight] = load(tmp_path, interval="1.07s").warnings
    assert "is tight: frame 80 of 720 takes" in tight
    assert load(tmp_path, interval="5s").warnings == []
    [ramped] = problems(tmp_path, interval="{from: 0.5s, to: 2s}")
    assert "timelapse.interval is 0.58 s and must be at least 1.03 s: frame 40 of 720" in ramped
    assert "(250 frames are too short)" in ramped


def test_settling_counts_with_the_longest_it_may_take(tmp_path: Path) -> None:
    [said] = problems(tmp_path, interval="2s", settle="{below: 0.05, at_most: 2s}")
    assert "must be at least 2.77 s" in said
    assert "settle 2 s" in said


def test_a_continuous_move_too_fast_for_its_interval_says_where(tmp_path: Path) -> None:
    [said] = problems(tmp_path, interval="0.003s", mode="continuous", exposure="0")
    assert "timelapse.interval must be at least 0.01 s, not 0.003 s: frame " in said
    assert "pan needs" in said


def test_the_rehearsal_is_as_long_as_the_clip_or_says_by_how_much_slower(tmp_path: Path) -> None:
    found = load(tmp_path, lead_in="12")
    shown = found.rehearsal()
    assert shown.move.duration == pytest.approx((719 + 12) / 24)
    assert [key.at for key in shown.keys[Axis.PAN]] == pytest.approx([12 / 24, 252 / 24, 731 / 24])
    assert shown.warnings == []
    hurried = load_text(tmp_path, FILE.replace("fps: 24", "fps: 480"))
    [slower] = hurried.rehearsal().warnings
    assert "x slower than the clip" in slower
    assert hurried.rehearsal().move.peaks()[Axis.PAN].velocity <= 120
    [unknown] = load_text(tmp_path, FILE.replace("fps: 24\n", "")).rehearsal().warnings
    assert "fps is not given: rehearsed at 24 frames a second" in unknown


def test_the_same_words_are_the_same_shoot_and_others_are_not(tmp_path: Path) -> None:
    found = load(tmp_path)
    assert load_text(tmp_path, FILE + "# a note\n").identity == found.identity
    assert load_text(tmp_path, FILE.replace("pan: 20", "pan: 21")).identity != found.identity
    assert load(tmp_path, exposure="0.4s").identity != found.identity


def test_a_file_without_the_section_is_no_timelapse(tmp_path: Path) -> None:
    (tmp_path / "film.yaml").write_text("keyframes: [{at: 0, pan: 0}]\n")
    assert load_timelapse(str(tmp_path / "film.yaml"), LIMITS, "the rig") is None
