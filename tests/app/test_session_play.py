"""A move that a program plays: refusals before anything moves, cameras, takes."""

from __future__ import annotations

import contextlib
import threading

import pytest
from waiting import wait_until

import teleop
from teleop.dji.gimbal import camera
from teleop.dji.message import ReturnCode

SHORT = {"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 10}]}
FILMED = {**SHORT, "cues": [{"at": 0, "camera": "record"}, {"at": 2, "camera": "stop"}]}
SLOW_RIG = """
name: Slow rig
links: {gimbal: "sim:"}
axes:
  pan:  {min: -90, max: 90, velocity: 5, acceleration: 10, jerk: 100}
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 20}
"""


LATE_RIG = """
name: Late rig
links: {gimbal: "sim:"}
axes: {pan: {min: -90, max: 90, velocity: 120, acceleration: 240, jerk: 1200}}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, simulated: {lag: 0.2, dead_time: 0.1}}]
"""


@pytest.fixture
def rig():
    with teleop.open("sim", virtual=True) as opened:
        yield opened


@pytest.fixture
def slow_rig(tmp_path):
    file = tmp_path / "slow.yaml"
    file.write_text(SLOW_RIG)
    with teleop.open(file, virtual=True) as opened:
        yield opened


def refuse_camera(rig):
    rig._session.rig.simulated["gimbal"]._handlers[camera.Command] = lambda _message, _now: ReturnCode.FAILED


def test_a_refused_camera_ends_the_play_and_leaves_the_rig_open(rig, tmp_path):
    refuse_camera(rig)
    report = rig.play(FILMED, take=tmp_path / "a.mcap")
    assert not report.ok
    assert report.reason == "the camera refused to record (return code 0x02)"
    assert teleop.read_take(tmp_path / "a.mcap").ended.startswith("failed")
    rig.move(pan=5)
    assert rig.angles()["pan"] == pytest.approx(5, abs=0.5)


def test_a_camera_that_refuses_a_program_leaves_the_rig_open(rig):
    refuse_camera(rig)
    for action in (rig.record, rig.shutter, rig.stop_recording):
        with pytest.raises(teleop.DeviceError, match="refused"):
            action()
    assert rig.play(SHORT).ok


def test_a_camera_that_refuses_the_last_cue_is_in_the_report(rig):
    refuse_camera(rig)
    report = rig.play({**SHORT, "cues": [{"at": 2, "camera": "record"}]})
    assert not report.ok
    assert "camera refused" in report.reason


def test_a_move_planned_for_a_faster_rig_is_unplayable(slow_rig):
    fast = teleop.plan(SHORT)
    with pytest.raises(teleop.UnplayableError, match="pan would exceed the limits of Slow rig: plan it for this rig"):
        slow_rig.play(fast)
    assert slow_rig.angles()["pan"] == 0


def test_a_move_with_axes_or_a_camera_that_the_rig_lacks_is_unplayable(slow_rig):
    with pytest.raises(teleop.UnplayableError, match="has no axis tilt"):
        slow_rig.play(teleop.plan({"keyframes": [{"at": 0, "tilt": 0}, {"at": 9, "tilt": 1}]}))
    with pytest.raises(teleop.UnplayableError, match="camera"):
        slow_rig.play(teleop.plan({**FILMED, "keyframes": [{"at": 0, "pan": 0}, {"at": 9, "pan": 1}]}))


def test_a_take_that_exists_is_named_as_the_argument_of_the_program(rig, tmp_path):
    file = tmp_path / "a.mcap"
    file.write_bytes(b"mine")
    with pytest.raises(teleop.UsageError) as error:
        rig.play(SHORT, take=file)
    assert str(error.value) == f"take={file}: already exists; choose another name, a take is never overwritten"
    assert file.read_bytes() == b"mine"
    with pytest.raises(teleop.UsageError, match=r"^take=.*its ending must be \.mcap"):
        rig.play(SHORT, take=tmp_path / "a.txt")


def test_a_play_that_finds_the_rig_busy_leaves_no_take(tmp_path):
    with teleop.open("sim") as rig:

        def move():
            with contextlib.suppress(teleop.StoppedError):
                rig.move(pan=170, seconds=60)

        mover = threading.Thread(target=move)
        mover.start()
        wait_until(lambda: rig.angles()["pan"] > 0.1, "the move to begin")
        with pytest.raises(teleop.BusyError, match="busy"):
            rig.play(SHORT, take=tmp_path / "a.mcap")
        rig.stop()
        mover.join()
    assert not (tmp_path / "a.mcap").exists()


def test_a_play_after_a_stop_says_how_to_go_on_and_makes_no_take(rig, tmp_path):
    rig.stop()
    report = rig.play(SHORT, take=tmp_path / "a.mcap")
    assert (report.ok, report.reason) == (False, "STOPPED: call clear() first, then play again")
    assert not (tmp_path / "a.mcap").exists()
    rig.clear()
    assert rig.play(SHORT).ok


def test_a_recorded_run_is_planned_and_played_again(rig, tmp_path):
    rig.play(SHORT, take=tmp_path / "a.mcap")
    assert rig.play(tmp_path / "a.mcap").ok
    assert rig.angles()["pan"] == pytest.approx(10, abs=0.5)


@pytest.mark.parametrize("sequence", [None, 3, ["reveal"]])
def test_what_is_no_sequence_is_an_error_of_the_api(rig, sequence):
    with pytest.raises(teleop.UsageError, match="must be a name, a file or a dict"):
        rig.play(sequence)


def test_a_gimbal_that_is_late_is_led_by_the_plan(tmp_path):
    (tmp_path / "late.yaml").write_text(LATE_RIG)
    move = {"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 45, "hold": 0.5}, {"at": 5, "pan": -15}]}
    with teleop.open(tmp_path / "late.yaml", virtual=True) as late:
        first, second = (late.play(move).axes["pan"] for _ in range(2))
    assert first.rms < 0.4
    assert second.rms < 0.05
    assert second.peak < 0.2
