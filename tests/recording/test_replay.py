"""A run is recorded, read back and repeated: the very same motion, or a refusal that says where."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command import teleop
from mcap.reader import make_reader

from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.recording.reader import read_take
from teleop.recording.replay import take_performance
from teleop.sequence.compile import load_sequence

LIMITS = load_profile("sim").limits
MOVE = """
keyframes:
  - {at: 0, pan: -20, tilt: 0}
  - {at: 2, pan: 10}
  - {at: 4, pan: 40, tilt: 8}
cues:
  - {at: 0, camera: record}
  - {at: 4, camera: stop}
"""


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("take")
    (place / "shoot.yaml").write_text(MOVE)
    done = teleop("play", "shoot.yaml", "--fast", "--take", "one.mcap", "--json", cwd=place)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["result"] == "done"
    return place / "one.mcap"


def test_what_was_commanded_is_in_the_file_for_any_reader_of_mcap(take: Path) -> None:
    with take.open("rb") as stream:
        messages = [
            (message.log_time, json.loads(message.data))
            for _, channel, message in make_reader(stream).iter_messages()
            if channel.topic == "/motion"
        ]
    move = load_sequence(str(take.with_name("shoot.yaml")), LIMITS, "sim").move
    begin = messages[-1][0] / 1e9
    ends = messages[-1][1]
    assert ends["pan"]["position"] == pytest.approx(40)
    assert len(messages) > 400
    moving = [state["pan"] for _, state in messages if abs(state["pan"]["velocity"]) > 1]
    peak = move.peaks()[Axis.PAN].velocity
    assert any(abs(state["velocity"]) == pytest.approx(peak, rel=0.01) for state in moving)
    assert begin > 0


def test_the_stream_of_a_repeat_is_the_recording(take: Path) -> None:
    recorded = read_take(take)
    move = take_performance(take, LIMITS, "sim").move
    first = recorded.times[0]
    begin = 5 * 0.01 if any(rows[1:, 0].any() for rows in recorded.motion.values()) else 0.0
    for axis in recorded.axes:
        again = move.sample(recorded.times - first + begin)[axis][:3]
        assert np.abs(again[0] - recorded.motion[axis][0]).max() < 1e-6
        assert np.abs(again[1] - recorded.motion[axis][1]).max() < 1e-6


def test_a_repeat_moves_the_rig_as_the_run_did_and_films_it(take: Path) -> None:
    done = teleop("play", take.name, "--fast", "--take", "two.mcap", "--json", cwd=take.parent)
    assert done.returncode == 0, done.stderr
    first, second = read_take(take), read_take(take.with_name("two.mcap"))
    assert [said["action"] for _, said in second.actions] == [said["action"] for _, said in first.actions]
    for axis in first.axes:
        path, again = first.motion[axis][0], second.motion[axis][0]
        assert again[-1] == pytest.approx(path[-1])
        assert (again.min(), again.max()) == pytest.approx((path.min(), path.max()), abs=1e-3)


def test_a_rig_that_cannot_do_it_is_told_where_and_by_how_much(take: Path) -> None:
    slower = {axis: replace(of, velocity=of.velocity / 10) for axis, of in LIMITS.items()}
    with pytest.raises(UnplayableError) as refusal:
        take_performance(take, slower, "slow rig")
    assert any(
        "pan needs" in problem and "x its velocity limit (slow rig)" in problem for problem in refusal.value.problems
    )
    with pytest.raises(UnplayableError) as refusal:
        take_performance(take, {Axis.PAN: LIMITS[Axis.PAN]}, "slider")
    assert refusal.value.problems == [f"{take}: moves tilt, but slider has only pan"]


def test_a_take_is_never_written_over_another_and_what_is_no_take_is_refused(take: Path) -> None:
    again = teleop("play", "shoot.yaml", "--fast", "--take", take.name, cwd=take.parent)
    assert again.returncode == 2
    assert again.stderr == "teleop: --take one.mcap: already exists; choose another name, a take is never overwritten\n"
    (take.parent / "not.mcap").write_text("keyframes: []\n")
    with pytest.raises(DocumentError) as refusal:
        read_take(take.parent / "not.mcap")
    assert "not a take (.mcap)" in refusal.value.problems[0]


@pytest.mark.parametrize("share", [0.5, 0.7, 0.9, 0.99])
def test_a_take_that_was_cut_is_read_as_far_as_it_is_whole(take: Path, tmp_path: Path, share: float) -> None:
    data = take.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[: int(share * len(data))])
    whole, left = read_take(take), read_take(cut)
    assert len(left.times) <= len(whole.times)
    for axis in left.axes:
        np.testing.assert_array_equal(left.motion[axis], whole.motion[axis][:, : len(left.times)])
    if len(left.times):
        move = take_performance(cut, LIMITS, "sim").move
        assert all(state.velocity == 0 and state.acceleration == 0 for state in move.at(move.duration).values())


def test_a_take_at_the_limits_themselves_is_repeated_at_its_own_speed(tmp_path: Path) -> None:
    (tmp_path / "sticks.csv").write_text("time,pan\n0,0\n0.5,1\n1.5,-0.6\n2.5,0\n3.5,0\n")
    done = teleop("live", "--sticks", "sticks.csv", "--fast", "--take", "full.mcap", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    again = teleop("play", "full.mcap", "--fast", "--take", "again.mcap", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    first, second = (read_take(tmp_path / name).motion[Axis.PAN] for name in ("full.mcap", "again.mcap"))
    assert abs(first[1]).max() == pytest.approx(LIMITS[Axis.PAN].velocity)
    assert (second[0].max(), second[0][-1]) == pytest.approx((first[0].max(), first[0][-1]), abs=1e-3)
    faster = teleop("play", "full.mcap", "--fast", "--speed", "120%", cwd=tmp_path)
    assert (faster.returncode, faster.stderr) == (
        2,
        "--speed 120%: maximum playback speed: 97 %, not 120 %\n",
    )
