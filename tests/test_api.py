"""The Python API, as a program uses it: mostly on the virtual clock; real processes where the promise is about one."""

# pyright: reportArgumentType=false, reportOptionalMemberAccess=false
# (an axis is named "pan", as programs do; a rig that is open has had a tick)

from __future__ import annotations

import gc
import json
import math
import os
import signal
import subprocess
import sys
import threading
import types
from pathlib import Path

import numpy as np
import pytest
from waiting import wait_until
from wire import tapped

import teleop
from teleop.core.axes import Axis
from teleop.core.run_state import RunState
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import ReturnCode

SHORT = {"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 10}]}
SPEED_RIG = """
name: Speed rig
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 120, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 90,  acceleration: 180, jerk: 900}
sinks:
  - {type: gimbal, link: gimbal, mode: speed, rate: 50}
"""


@pytest.fixture
def rig():
    with teleop.open("sim", links={"gimbal": "sim:"}, virtual=True) as opened:
        yield opened


@pytest.fixture
def speed_rig(tmp_path):
    file = tmp_path / "speed.yaml"
    file.write_text(SPEED_RIG)
    return file


def at_time(rig, seconds, act):
    """Have `act` called by the control loop, `seconds` after now on the rig's clock."""
    device, begin = rig._session.rig.simulated["gimbal"], rig._session.clock.now()
    advance, due = device.advance, [act]

    def watched(now):
        if due and now >= begin + seconds:
            due.pop()()
        return advance(now)

    device.advance = watched


def commanded(rig):
    """The state that pan was last commanded to."""
    return rig._session.program.tick.motion[Axis.PAN]


def ended(rig):
    return rig._session._supervisor.state is RunState.OVER


def process(script, *arguments):
    """Run a program of its own; a fault of the machine would be a timeout."""
    paths = os.pathsep.join(path for path in sys.path if path)
    return subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=100,
        stdin=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": paths},
        check=False,
    )


# --- plan


def test_a_plan_has_the_duration_and_the_state_of_each_axis():
    move = teleop.plan(SHORT)
    assert move.duration == pytest.approx(2)
    state = move.at(1)["pan"]
    assert (state.position, state.acceleration) == pytest.approx((5, 0), abs=1e-6)
    assert state.velocity > 5
    assert move.at(2)["pan"] == pytest.approx((10, 0, 0), abs=1e-6)


def test_a_plan_is_sampled_into_arrays_by_axis():
    move = teleop.plan(SHORT)
    pan = move.sample([0, 1, 2])["pan"]
    assert isinstance(pan, np.ndarray)
    assert pan[0] == pytest.approx([0, 5, 10], abs=1e-6)
    assert pan[1][1] == pytest.approx(move.at(1)["pan"].velocity)


@pytest.mark.parametrize("kind", [str, Path])
def test_a_plan_is_made_of_a_file_and_of_its_content_alike(tmp_path, kind):
    file = tmp_path / "shoot.yaml"
    file.write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 2, pan: 10}\n")
    assert teleop.plan(kind(file), rig="rs2").at(0.7) == teleop.plan(SHORT, "rs2").at(0.7)


def test_a_plan_takes_numbers_of_numpy():
    keys = [{"at": np.float64(0), "pan": np.int64(0)}, {"at": np.float32(2), "pan": np.array(10)}]
    assert teleop.plan({"keyframes": keys}).at(1) == teleop.plan(SHORT).at(1)


def test_a_timelapse_is_planned_as_its_rehearsal():
    move = teleop.plan("day-to-night")
    assert move.duration > 0
    assert move.axes


def test_a_plan_shows_itself_in_a_notebook_and_as_a_figure():
    move = teleop.plan(SHORT)
    assert "<iframe" in move._repr_html_()
    assert len(move.plot().axes) >= 3


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pam": 10}]}, "pam"),
        ({"keyframes": [{"at": 0, "pan": object()}]}, "sequence"),
        ("no-such-sequence", "no-such-sequence"),
    ],
)
def test_a_mistake_in_a_sequence_is_an_error_of_the_api(content, words):
    with pytest.raises(teleop.TeleopError, match=words):
        teleop.plan(content)


def test_a_move_that_the_rig_cannot_make_is_unplayable():
    with pytest.raises(teleop.UnplayableError):
        teleop.plan({"keyframes": [{"at": 0, "pan": 0}, {"at": 0.1, "pan": 90}]})


# --- move, jog


def test_a_move_arrives_in_its_time(rig):
    begin = rig._session.clock.now()
    rig.move(pan=30, tilt=5, seconds=2)
    assert rig._session.clock.now() - begin == pytest.approx(2, abs=0.2)
    assert rig.angles()["pan"] == pytest.approx(30, abs=0.5)
    assert rig.angles()["tilt"] == pytest.approx(5, abs=0.5)


def test_a_move_without_a_time_is_as_fast_as_the_limits_allow(rig):
    begin = rig._session.clock.now()
    rig.move(pan=90)
    fast = rig._session.clock.now() - begin
    assert rig.angles()["pan"] == pytest.approx(90, abs=0.5)
    assert fast < 2  # 90 deg at 120 deg/s, with ramps of 0.5 and 0.2 s


def test_a_time_is_refused_only_when_the_limits_do_not_allow_it(rig):
    exact = 90 / 120 + 120 / 240 + 240 / 1200  # the seven segments of a jerk-limited move
    with pytest.raises(teleop.UsageError, match=r"this move needs 1\.45 s"):
        rig.move(pan=90, seconds=exact - 0.01)
    assert rig.angles()["pan"] == 0
    begin = rig._session.clock.now()
    rig.move(pan=90, seconds=exact)
    assert rig._session.clock.now() - begin == pytest.approx(exact, abs=0.2)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "name an axis"),
        ({"yaw": 3}, "no axis yaw"),
        ({"pan": 181}, "soft limits, -180 to 180"),
        ({"pan": math.nan}, "finite number"),
        ({"pan": "left"}, "must be a number"),
        ({"pan": 1, "seconds": -1}, "seconds"),
        ({"pan": 1, "seconds": math.nan}, "seconds"),
    ],
)
def test_a_move_that_cannot_be_is_refused_before_anything_moves(rig, arguments, words):
    with pytest.raises(teleop.UsageError, match=words):
        rig.move(**arguments)
    assert rig.angles()["pan"] == 0


def test_a_jog_moves_for_its_time_and_then_stops(rig):
    rig.jog(pan=10, seconds=1)
    state = commanded(rig)
    assert state.velocity == 0
    assert state.position == pytest.approx(10, abs=0.5)


def test_a_jog_stops_at_the_soft_limit(rig):
    rig.jog(pan=100, seconds=3)
    assert commanded(rig).position == pytest.approx(180, abs=1e-3)


@pytest.mark.parametrize(
    "arguments", [{"pan": 121, "seconds": 1}, {"pan": 1, "seconds": 0}, {"pan": math.nan, "seconds": 1}, {"seconds": 1}]
)
def test_a_jog_beyond_the_limits_is_refused(rig, arguments):
    with pytest.raises(teleop.UsageError):
        rig.jog(**arguments)


# --- play


def test_a_report_has_the_axes_of_the_move_alone(rig):
    report = rig.play(SHORT)
    assert (report.ok, report.reason) == (True, "")
    assert list(report.axes) == ["pan"]
    assert report.axes["pan"].readings > 10
    assert 0 <= report.axes["pan"].rms <= report.axes["pan"].peak < 1


def test_a_planned_move_is_played_and_recorded(rig, tmp_path):
    move = teleop.plan(SHORT)
    report = rig.play(move, take=tmp_path / "a.mcap")
    take = teleop.read_take(tmp_path / "a.mcap")
    assert report.ok
    assert report.take == tmp_path / "a.mcap"
    assert take.ended == "done"
    assert take.motion["pan"][0][-1] == pytest.approx(10, abs=1e-3)
    assert take.measured["pan"][1][-1] == pytest.approx(10, abs=0.5)
    assert len(take.times) == take.motion["pan"].shape[1]


def test_a_take_is_never_written_over_another(rig, tmp_path):
    rig.play(SHORT, take=tmp_path / "a.mcap")
    with pytest.raises(teleop.UsageError, match=r"a\.mcap"):
        rig.play(SHORT, take=tmp_path / "a.mcap")


def test_the_same_program_makes_the_same_motion(tmp_path):
    takes = []
    for name in ("a.mcap", "b.mcap"):
        with teleop.open("sim", virtual=True) as rig:
            rig.move(pan=-20, seconds=2)
            rig.play(SHORT, take=tmp_path / name)
        takes.append(teleop.read_take(tmp_path / name))
    first, second = takes
    assert np.array_equal(first.times, second.times)
    for axis in first.axes:
        assert np.array_equal(first.motion[axis], second.motion[axis])
        assert np.array_equal(first.measured[axis], second.measured[axis])


def test_a_sequence_gives_the_gimbal_its_commands(rig):
    tap = tapped(rig._session.rig)
    assert rig.play({**SHORT, "cues": [{"at": 0, "send": "gimbal set_stiffness pitch=40 roll=40 yaw=40"}]}).ok
    assert len(tap.of(gimbal.SetStiffness)) == 1


@pytest.mark.parametrize("speed", [0, -1, math.nan, math.inf])
def test_a_speed_must_be_above_0(rig, speed):
    with pytest.raises(teleop.UsageError, match="speed"):
        rig.play(SHORT, speed=speed)


# --- camera


def test_the_camera_records_stops_and_shoots(rig):
    tap = tapped(rig._session.rig)
    rig.record()
    rig.stop_recording()
    rig.shutter()
    assert len(tap.of(camera.Command)) == 3


def test_a_camera_that_refuses_is_a_device_error(rig):
    simulated = rig._session.rig.simulated["gimbal"]
    simulated._handlers[camera.Command] = lambda _message, _now: ReturnCode.FAILED
    with pytest.raises(teleop.DeviceError, match="the camera refused to record"):
        rig.record()


def test_a_rig_without_a_camera_is_an_error(speed_rig):
    with teleop.open(speed_rig, virtual=True) as rig, pytest.raises(teleop.UsageError, match="no camera"):
        rig.shutter()


# --- stop


def test_a_stop_ramps_to_rest_and_is_latched(rig):
    at_time(rig, 1, rig.stop)
    with pytest.raises(teleop.StoppedError):
        rig.move(pan=90, seconds=3)
    state = commanded(rig)
    assert state.velocity == 0
    assert 1 < state.position < 80
    with pytest.raises(teleop.StoppedError, match="clear"):
        rig.move(pan=0)
    rig.clear()
    rig.move(pan=0)
    assert rig.angles()["pan"] == pytest.approx(0, abs=0.5)


def test_a_stop_during_a_sequence_is_in_the_report_and_the_take_has_the_ramp(rig, tmp_path):
    at_time(rig, 1, rig.stop)
    report = rig.play({"keyframes": [{"at": 0, "pan": 0}, {"at": 4, "pan": 60}]}, take=tmp_path / "a.mcap")
    assert not report.ok
    assert report.reason == "STOPPED"
    assert teleop.read_take(tmp_path / "a.mcap").motion["pan"][1][-1] == 0
    assert rig.stopped


def test_a_stop_from_another_thread_on_the_real_clock():
    with teleop.open("sim") as rig:
        errors = []

        def move():
            try:
                rig.move(pan=170, seconds=60)
            except teleop.StoppedError as error:
                errors.append(error)

        mover = threading.Thread(target=move)
        mover.start()
        wait_until(lambda: rig.angles()["pan"] > 0.1, "the move to begin")
        with pytest.raises(teleop.BusyError, match="busy"):
            rig.jog(pan=1, seconds=1)
        with pytest.raises(teleop.BusyError, match="busy"):
            rig.play(SHORT)
        rig.stop()
        mover.join()
        assert len(errors) == 1
        assert commanded(rig).velocity == 0


# --- the end of a run


def test_leaving_the_block_stops_releases_and_closes(speed_rig):
    with teleop.open(speed_rig, virtual=True) as rig:
        tap = tapped(rig._session.rig)
        rig.move(pan=20)
    speeds = [message for _, message in tap.of(gimbal.Speed)]
    assert ended(rig)
    assert not speeds[-1].take_over
    assert (speeds[-2].yaw, speeds[-2].roll, speeds[-2].pitch) == (0, 0, 0)
    with pytest.raises(teleop.TeleopError, match="closed"):
        rig.angles()
    rig.close()


def test_an_exception_in_the_block_ends_the_run_and_is_raised(speed_rig):
    class OwnError(Exception):
        pass

    rig = teleop.open(speed_rig, virtual=True)
    tap = tapped(rig._session.rig)

    def program():
        with rig:
            rig.move(pan=5)
            raise OwnError

    with pytest.raises(OwnError):
        program()
    assert ended(rig)
    assert not tap.of(gimbal.Speed)[-1][1].take_over


def test_ctrl_c_on_the_virtual_clock_is_raised_as_such_once_all_rests():
    def interrupt():
        raise KeyboardInterrupt

    rig = teleop.open("sim", virtual=True)
    at_time(rig, 1, interrupt)

    def program():
        with rig:
            rig.move(pan=90, seconds=5)

    with pytest.raises(KeyboardInterrupt):
        program()
    assert ended(rig)
    assert commanded(rig).velocity == 0


CTRL_C = """
import json, os, signal, sys, threading, time
import teleop
from teleop.dji.gimbal import messages as gimbal
from wire import tapped

rig = teleop.open(sys.argv[1])
tap = tapped(rig._session.rig)

def interrupt():
    while rig.angles()["pan"] < 1:
        time.sleep(0.01)
    os.kill(os.getpid(), signal.SIGINT)

raised = False
try:
    with rig:
        threading.Thread(target=interrupt).start()
        rig.move(pan=170, seconds=60)
except KeyboardInterrupt:
    raised = True
speeds = [message for _, message in tap.of(gimbal.Speed)]
state = rig._session.program.tick.motion["pan"]
print(json.dumps({
    "raised": raised,
    "over": rig._session.over,
    "velocity": state.velocity,
    "held": speeds[-1].take_over,
    "zero": [speeds[-2].yaw, speeds[-2].roll, speeds[-2].pitch],
    "threads": threading.active_count(),
}))
"""


def test_ctrl_c_in_a_real_process_stops_releases_and_is_raised(speed_rig):
    ran = process(CTRL_C, speed_rig)
    assert ran.stderr == ""
    found = json.loads(ran.stdout)
    assert found.pop("zero") == [0, 0, 0]
    assert found == {"raised": True, "over": True, "velocity": 0, "held": False, "threads": 1}


def test_a_gimbal_that_dies_during_a_move_is_a_device_error(rig):
    at_time(rig, 1, lambda: mute(rig))
    with pytest.raises(teleop.DeviceError, match="gimbal"):
        rig.move(pan=90, seconds=5)
    with pytest.raises(teleop.DeviceError, match="the run has ended"):
        rig.angles()


def test_a_gimbal_that_dies_during_a_sequence_is_in_the_report(rig):
    at_time(rig, 1, lambda: mute(rig))
    report = rig.play({"keyframes": [{"at": 0, "pan": 0}, {"at": 5, "pan": 60}]})
    assert not report.ok
    assert "gimbal" in report.reason


def mute(rig):
    device = rig._session.rig.simulated["gimbal"]
    device.advance = lambda _now: b""


# --- the process


def left():
    gc.collect()
    handlers = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    threads = {thread.name for thread in threading.enumerate()}
    return threads, len(os.listdir("/proc/self/fd")), handlers, sys.getswitchinterval(), gc.get_freeze_count()


def test_ten_runs_leave_the_process_as_they_found_it(tmp_path):
    with teleop.open("sim", virtual=True) as rig:
        rig.play(SHORT)  # what is loaded at first use stays
    found = left()
    for number in range(10):
        with teleop.open("sim", virtual=number % 2 == 0) as rig:
            if number % 2 == 0:
                rig.play(SHORT, take=tmp_path / f"{number}.mcap")
            else:
                rig.move(pan=1)
    assert left() == found


def test_two_rigs_at_once_leave_the_switch_interval_as_it_was():
    found = sys.getswitchinterval()
    first, second = teleop.open("sim"), teleop.open("sim")
    try:
        first.move(pan=3)
        second.move(tilt=2)
        assert first.angles()["pan"] == pytest.approx(3, abs=0.5)
        assert second.angles()["pan"] == pytest.approx(0, abs=0.5)
        assert sys.getswitchinterval() < found
    finally:
        first.close()
        assert sys.getswitchinterval() < found
        second.close()
    assert sys.getswitchinterval() == found


def test_a_rig_works_in_a_thread_that_is_not_the_main_one():
    found = []

    def work():
        with teleop.open("sim") as rig:
            rig.move(pan=2)
            found.append(rig.angles()["pan"])

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [pytest.approx(2, abs=0.5)]


QUIET = """
import sys
import teleop
rig = teleop.open("sim", virtual="real" not in sys.argv)
rig.move(pan=3)
if "real" not in sys.argv:
    rig.play({"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 10}]})
if "close" in sys.argv:
    rig.close()
if "fail" in sys.argv:
    raise ValueError("the program's own")
"""


@pytest.mark.parametrize("arguments", [("close",), (), ("real",), ("fail",), ("real", "fail")])
def test_nothing_is_printed_not_even_at_exit(arguments):
    ran = process(QUIET, *arguments)
    assert ran.stdout == ""
    if "fail" in arguments:
        assert ran.stderr.startswith("Traceback")
        assert ran.stderr.endswith("ValueError: the program's own\n")
        assert "nanobind" not in ran.stderr
    else:
        assert (ran.returncode, ran.stderr) == (0, "")


# --- opening, values


def test_a_real_link_has_no_virtual_clock():
    with pytest.raises(teleop.UsageError, match="virtual=True"):
        teleop.open("sim", links={"gimbal": "serial:/dev/ttyX@230400"}, virtual=True)


@pytest.mark.parametrize("arguments", [{"rig": "no-such-rig"}, {"links": {"camera": "sim:"}}])
def test_a_rig_that_cannot_be_opened_is_an_error_of_the_api(arguments):
    with pytest.raises(teleop.TeleopError):
        teleop.open(**arguments)


def test_every_name_is_there_and_every_error_is_one_of_the_api():
    names = {name: getattr(teleop, name) for name in teleop.__all__}
    errors = [value for name, value in names.items() if name.endswith("Error")]
    assert all(issubclass(error, teleop.TeleopError) for error in errors)
    assert teleop.__version__
    assert (Path(teleop.__file__).parent / "py.typed").exists()


def test_a_take_without_pandas_says_so(rig, tmp_path, monkeypatch):
    rig.play(SHORT, take=tmp_path / "a.mcap")
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(teleop.UsageError, match="needs pandas"):
        teleop.read_take(tmp_path / "a.mcap").to_frame()


def test_a_take_gives_its_columns_to_pandas(rig, tmp_path, monkeypatch):
    rig.play(SHORT, take=tmp_path / "a.mcap")
    fake = types.SimpleNamespace(DataFrame=lambda columns, index: (columns, index), Index=lambda values, name: values)
    monkeypatch.setitem(sys.modules, "pandas", fake)
    take = teleop.read_take(tmp_path / "a.mcap")
    columns, index = take.to_frame()
    assert np.array_equal(columns["pan"], take.motion["pan"][0])
    measured = columns["pan_measured"]
    assert measured[~np.isnan(measured)][-1] == pytest.approx(10, abs=0.5)
    assert {len(column) for column in columns.values()} == {len(index)}


def test_a_take_becomes_a_real_data_frame(rig, tmp_path):
    pandas = pytest.importorskip("pandas", reason="pandas is an extra of the tests")
    rig.play(SHORT, take=tmp_path / "a.mcap")
    take = teleop.read_take(tmp_path / "a.mcap")
    frame = take.to_frame()
    assert isinstance(frame, pandas.DataFrame)
    assert frame.index.name == "time"
    assert {"pan", "pan_velocity", "pan_acceleration", "pan_measured"} <= set(frame.columns)
    assert np.array_equal(frame["pan"].to_numpy(), take.motion["pan"][0])
    assert frame["pan"].iloc[-1] == pytest.approx(10, abs=1e-3)
    assert frame["pan_measured"].dropna().iloc[-1] == pytest.approx(10, abs=0.5)


# --- what users try


def test_a_stop_before_a_move_is_latched_and_says_how_to_go_on(rig):
    rig.stop()
    rig.stop()
    for call in (lambda: rig.move(pan=1), lambda: rig.jog(pan=1, seconds=1)):
        with pytest.raises(teleop.StoppedError, match=r"STOPPED: call clear\(\) first, then move again"):
            call()
    rig.clear()
    rig.clear()
    rig.move(pan=1)


def test_a_stopped_rig_can_still_stop_its_camera(rig):
    rig.record()
    rig.stop()
    rig.stop_recording()
    with pytest.raises(teleop.StoppedError):
        rig.move(pan=1)


def test_a_stop_during_a_jog_ends_it_at_rest(rig):
    at_time(rig, 0.5, rig.stop)
    with pytest.raises(teleop.StoppedError):
        rig.jog(pan=20, seconds=5)
    assert commanded(rig).velocity == 0


def test_recording_twice_asks_the_camera_twice(rig):
    tap = tapped(rig._session.rig)
    rig.record()
    rig.record()
    assert len(tap.of(camera.Command)) == 2


def test_a_camera_on_a_link_of_its_own_answers_too(tmp_path):
    file = tmp_path / "two-links.yaml"
    camera_sink = "  - {type: camera, link: camera}\n"
    file.write_text(SPEED_RIG.replace('"sim:"}', '"sim:", camera: "sim:"}') + camera_sink)
    with teleop.open(file, virtual=True) as rig:
        rig.record()
        rig._session.rig.simulated["camera"]._handlers[camera.Command] = lambda _message, _now: ReturnCode.FAILED
        with pytest.raises(teleop.DeviceError, match="refused"):
            rig.stop_recording()


def test_a_closed_rig_says_so_in_every_call_and_closes_again():
    rig = teleop.open("sim", virtual=True)
    rig.close()
    rig.close()
    calls = (
        rig.angles,
        lambda: rig.move(pan=1),
        lambda: rig.move(pan=1, seconds=9),
        lambda: rig.jog(pan=1, seconds=1),
        lambda: rig.play(SHORT),
        rig.record,
        rig.stop_recording,
        rig.shutter,
    )
    for call in calls:
        with pytest.raises(teleop.TeleopError, match="the rig is closed: open it again"):
            call()
    rig.stop()


def test_a_drone_is_refused_with_the_way_to_fly_it():
    with teleop.open("m100", links={"drone": "sim:", "gimbal": "sim:"}, virtual=True) as rig:
        assert not any(axis.is_stick for axis in rig.axes)
        with pytest.raises(teleop.UsageError, match="stick_roll flies a drone, which needs an operator"):
            rig.jog(stick_roll=0.1, seconds=1)
        flown = teleop.plan({"keyframes": [{"at": 0, "stick_roll": 0}, {"at": 2, "stick_roll": 0}]}, rig="m100")
        with pytest.raises(teleop.UsageError, match="needs an operator: use `teleop play`"):
            rig.play(flown)
        rig.move(pan=1)


def test_a_wrong_link_is_named_as_a_program_names_it():
    with pytest.raises(teleop.DocumentError) as error:
        teleop.open("sim", links={"camera": "sim:"}, virtual=True)
    assert "--" not in str(error.value)
    assert str(error.value).startswith("link camera:")


def test_every_error_is_one_line_that_names_its_place(rig, tmp_path):
    errors = []
    for call in (
        lambda: rig.move(),
        lambda: rig.move(yaw=1),
        lambda: rig.move(pan=999),
        lambda: rig.move(pan=90, seconds=0),
        lambda: rig.jog(yaw=1, seconds=1),
        lambda: rig.jog(pan=1, seconds=math.nan),
        lambda: rig.jog(pan=1, seconds="long"),
        lambda: rig.play(SHORT, speed=0),
        lambda: rig.play(tmp_path / "none.yaml"),
        lambda: rig.play({}),
        lambda: rig.play(SHORT, take=tmp_path / "no" / "a.mcap"),
        lambda: teleop.read_take(tmp_path / "none.mcap"),
        lambda: teleop.open(tmp_path / "none.yaml"),
    ):
        with pytest.raises(teleop.TeleopError) as error:
            call()
        errors.append(str(error.value))
    assert all(text and "\n" not in text and "--" not in text for text in errors), errors
    assert rig.angles()["pan"] == 0
