"""A table by the frame in a sequence: met at every frame, legal, with a run-up before it and a run-out after it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.planner.keyframes.program import HEADROOM
from teleop.sequence.compile import CompiledSequence, load_sequence

PROFILE = load_profile("sim")
LIMITS, DEVICES = PROFILE.limits, ("gimbal", "camera")
FRAMES = np.arange(240) / 24
NOISE = np.random.default_rng(4)
PAN = 20 * np.sin(0.8 * FRAMES + 0.3) + NOISE.normal(0, 0.02, 240)
TILT = 5 + 10 * np.cos(0.5 * FRAMES) + NOISE.normal(0, 0.02, 240)
ROLL = 3 * np.sin(1.3 * FRAMES)


def table(folder: Path, **columns: np.ndarray) -> None:
    rows = zip(*columns.values(), strict=True)
    lines = [",".join(columns), *(",".join(f"{value:.6f}" for value in row) for row in rows)]
    (folder / "track.csv").write_text("\n".join(lines) + "\n")


def loaded(
    folder: Path, source: str, more: str = "", devices: tuple[str, ...] = ("gimbal", "camera")
) -> CompiledSequence:
    (folder / "move.yaml").write_text(f"source: {{file: track.csv, fps: 24, {source}}}\n{more}")
    return load_sequence(str(folder / "move.yaml"), LIMITS, "the rig", devices)


def refusal(folder: Path, source: str, more: str = "") -> list[str]:
    with pytest.raises(DocumentError) as error:
        loaded(folder, source, more)
    return [line.removeprefix(f"{folder}/") for line in error.value.problems]


def test_every_frame_is_met_within_the_tolerance_with_few_keys_and_within_the_limits(tmp_path: Path) -> None:
    table(tmp_path, rx=TILT, ry=PAN, rz=ROLL)
    found = loaded(tmp_path, "columns: {pan: ry, tilt: rx, roll: rz}, tolerance: {pan: 0.1, tilt: 0.15, roll: 0.05}")
    lead = found.cues[0].at
    for axis, values, tolerance in ((Axis.PAN, PAN, 0.1), (Axis.TILT, TILT, 0.15), (Axis.ROLL, ROLL, 0.05)):
        track, limits = found.move.tracks[axis], LIMITS[axis]
        off = track.sample(lead + FRAMES)[0] - values
        assert np.abs(off).max() <= tolerance
        assert len(found.keys[axis]) <= 30
        peaks = track.peaks()
        for name in ("velocity", "acceleration", "jerk"):
            assert getattr(peaks, name) <= 1.02 * HEADROOM * getattr(limits, name)
        assert found.frames[axis][0].deviation(track).size == pytest.approx(np.abs(off).max(), abs=1e-6)


def test_it_gets_to_speed_before_the_first_frame_and_records_from_there_to_the_last(tmp_path: Path) -> None:
    table(tmp_path, ry=8 * FRAMES)
    found = loaded(tmp_path, "columns: {pan: ry}, tolerance: 0.05")
    (record, stop), track = found.cues, found.move.tracks[Axis.PAN]
    assert (record.action, stop.action) == (Action.RECORD, Action.STOP)
    assert 0 < record.at < 1
    assert stop.at - record.at == pytest.approx(239 / 24)
    assert stop.at < found.move.duration
    assert track.at(0.0).velocity == 0
    assert track.at(record.at).velocity == pytest.approx(8, abs=0.4)
    assert track.at(stop.at).velocity == pytest.approx(8, abs=0.4)
    assert track.at(found.move.duration).velocity == 0


def test_a_table_that_begins_and_ends_at_rest_needs_no_run_up(tmp_path: Path) -> None:
    table(tmp_path, ry=10 * np.cos(np.linspace(0, np.pi, 240)))
    found = loaded(tmp_path, "columns: {pan: ry}")
    assert found.cues[0].at == 0
    assert found.move.duration == pytest.approx(239 / 24)


def test_a_run_up_can_be_given_and_the_times_of_the_file_count_from_the_first_frame(tmp_path: Path) -> None:
    table(tmp_path, ry=8 * FRAMES)
    more = "keyframes:\n  - {at: 0, focus: 0.2}\n  - {at: 5s, focus: 0.8}\ncues:\n  - {at: 1s, camera: record}\n"
    found = loaded(tmp_path, "columns: {pan: ry}, run_up: 2s, run_out: 3s", more)
    assert [(cue.at, cue.name) for cue in found.cues] == [(3.0, "record")]
    assert [key.at for key in found.keys[Axis.FOCUS]] == [2.0, 7.0]
    assert found.move.duration == pytest.approx(2 + 239 / 24 + 3)
    assert loaded(tmp_path, "columns: {pan: ry}, record: false").cues == []
    assert loaded(tmp_path, "columns: {pan: ry}", devices=("gimbal",)).cues == []


def test_scale_offset_and_the_seam_at_180_degrees(tmp_path: Path) -> None:
    turned = (170 + 10 * FRAMES + 180) % 360 - 180  # 170 .. 269.6, over the seam
    table(tmp_path, ry=turned, f=np.linspace(0, 4095, 240))
    columns = "{pan: {column: ry, scale: -1, offset: 200}, focus: {column: 2, scale: 0.0002442}}"
    found = loaded(tmp_path, f"columns: {columns}")
    lead, pan = found.cues[0].at, found.move.tracks[Axis.PAN]
    assert np.abs(pan.sample(lead + FRAMES)[0] - (30 - 10 * FRAMES)).max() <= 0.1
    assert np.abs(found.move.tracks[Axis.FOCUS].at(lead + FRAMES[-1]).position - 1) <= 0.001


def test_frames_have_numbers_and_may_be_missing(tmp_path: Path) -> None:
    kept = np.arange(240) % 3 != 1
    table(tmp_path, frame=1001 + np.flatnonzero(kept), ry=PAN[kept])
    found = loaded(tmp_path, "columns: {pan: ry}")
    frames = found.frames[Axis.PAN][0]
    assert (frames.numbers[:3], len(frames.times)) == ([1001, 1003, 1004], 160)
    assert frames.deviation(found.move.tracks[Axis.PAN]).size <= 0.1
    assert found.keys[Axis.PAN][1].where.startswith("frame 10")


def test_a_table_that_is_too_fast_is_refused_with_a_rate_that_does(tmp_path: Path) -> None:
    table(tmp_path, ry=60 * np.sin(3 * FRAMES))
    (problem,) = refusal(tmp_path, "columns: {pan: ry}")
    assert problem.startswith("move.yaml:1:9: source: pan is too fast for the rig (its velocity would be 1.5")
    slower = problem.split("use fps: ")[1].split(" ")[0]
    (tmp_path / "move.yaml").write_text(f"source: {{file: track.csv, fps: {slower}, columns: {{pan: ry}}}}\n")
    found = load_sequence(str(tmp_path / "move.yaml"), LIMITS, "the rig")
    peak = found.move.tracks[Axis.PAN].peaks().velocity
    assert peak > 0.85 * LIMITS[Axis.PAN].velocity  # no slower than it has to be


def test_fit_stretch_slows_a_table_down_and_says_so(tmp_path: Path) -> None:
    table(tmp_path, ry=60 * np.sin(3 * FRAMES))
    found = loaded(tmp_path, "columns: {pan: ry}", "fit: stretch\n")
    assert "stretched the table 1." in found.warnings[0]
    assert found.frames[Axis.PAN][0].deviation(found.move.tracks[Axis.PAN]).size <= 0.1


def test_no_room_for_a_run_up_is_said(tmp_path: Path) -> None:
    table(tmp_path, ry=179.9 - 20 * FRAMES[:240])
    (problem,) = refusal(tmp_path, "columns: {pan: ry}")
    assert ": pan cannot get to speed before frame 1 within -180..180 (the rig); use" in problem


def test_a_table_within_another_sequence_keeps_its_speed(tmp_path: Path) -> None:
    table(tmp_path, ry=8 * FRAMES)
    loaded(tmp_path, "columns: {pan: ry}")
    (tmp_path / "whole.yaml").write_text(
        "include:\n  - {move: move.yaml, at: 2s, speed: 50%}\nkeyframes:\n  - {at: 0, tilt: 0}\n"
    )
    whole = load_sequence(str(tmp_path / "whole.yaml"), LIMITS, "the rig")
    frames = whole.frames[Axis.PAN][0]
    assert np.diff(frames.times) == pytest.approx(2 / 24)
    assert whole.cues[0].at == pytest.approx(frames.times[0])
    assert frames.deviation(whole.move.tracks[Axis.PAN]).size <= 0.1


@pytest.mark.parametrize(
    ("source", "problem"),
    [
        ("columns: {}", "move.yaml:1:45: source.columns names no axis: write {pan: ry}"),
        ("columns: {pan: rz}", "source.columns.pan: track.csv has no column 'rz'; it has rx, text, ry"),
        ("columns: {yaw: ry}", "unknown key `yaw`: yaw is called pan here"),
        ("columns: {pan: ry}, tolerance: 0", "source.tolerance must be a number above 0, not 0"),
        ("columns: {pan: ry}, tolerance: {pen: 1}", "source.tolerance.pen: unknown key `pen`; did you mean `pan`?"),
        ("columns: {pan: ry}, run_up: soon", "source.run_up must be auto or a time (4, 4s,"),
        ("columns: {pan: ry}, frame: rx", "track.csv:2:2: a frame must be a whole number, not 0.5"),
        ("columns: {pan: rx, tilt: text}", "track.csv:2:6: 'text' must be a number, not 'a'"),
        (
            "columns: {tilt: {column: rx, offset: 200}}",
            "track.csv:4:2: tilt must be within -56..146 (the rig), not 202",
        ),
    ],
)
def test_what_is_wrong_is_named_at_its_place(source: str, problem: str, tmp_path: Path) -> None:
    (tmp_path / "track.csv").write_text("rx,text,ry\n 0.5,a,1\n 1.5,b,2\n 2.5,c,3\n")
    lines = refusal(tmp_path, source)
    assert any(problem in line.replace(f"{tmp_path}/", "") for line in lines), lines


def test_what_else_is_wrong_with_a_source(tmp_path: Path) -> None:
    assert refusal(tmp_path, "columns: {pan: ry}") == ["move.yaml:1:16: source.file: no such file: track.csv"]
    table(tmp_path, frame=np.array([1.0, 3.0, 2.0]), ry=np.zeros(3))
    assert refusal(tmp_path, "columns: {pan: ry}") == ["track.csv:4:1: frame 2 must be after frame 3"]
    (tmp_path / "move.yaml").write_text("source: {file: track.csv, columns: {pan: ry}}\n")
    with pytest.raises(DocumentError, match="needs fps: how many frames"):
        load_sequence(str(tmp_path / "move.yaml"), LIMITS, "the rig")
    (tmp_path / "move.yaml").write_text("source: {file: track.csv, fps: 24, columns: {stick_yaw: ry}}\n")
    with pytest.raises(UnplayableError, match="the rig has no stick_yaw"):
        load_sequence(str(tmp_path / "move.yaml"), LIMITS, "the rig")
