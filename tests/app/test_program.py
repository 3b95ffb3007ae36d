"""The jobs of a program, one at a time, in a loop that is turned by hand."""

from __future__ import annotations

import pytest

from teleop.app.program import BusyError, EventJob, JogJob, MoveJob, ProgramSource, StoppedError
from teleop.core.axes import Axis, Reading, State
from teleop.core.errors import DeviceError, TeleopError
from teleop.core.events import Action, Tick
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import PositionTarget, Stop, VelocityTarget

AT_REST = Feedback({Axis.PAN: State(0)}, {})


def tick(time, state, reading=None):
    reported = {} if reading is None else {Axis.PAN: Reading(reading, time)}
    return Tick(time, {Axis.PAN: state}, {}, (), reported)


@pytest.fixture
def program():
    source = ProgramSource()
    source.start(0.0, {Axis.PAN: State(0)})
    source.observe(tick(0.0, State(0)))
    return source


def test_a_move_asks_for_its_target_and_ends_when_the_readings_are_there(program):
    program.submit(MoveJob({Axis.PAN: 10}, None))
    demand, _ = program.read(1.0, AT_REST)
    assert demand == {Axis.PAN: PositionTarget(10, None)}
    program.observe(tick(1.0, State(10), reading=7))
    assert not program.finished
    program.observe(tick(1.1, State(10), reading=9.9))
    assert program.finished
    program.result()


def test_a_move_that_does_not_arrive_is_a_device_error(program):
    program.submit(MoveJob({Axis.PAN: 10}, None))
    program.read(1.0, AT_REST)
    for time in (1.0, 2.0, 3.5):
        program.observe(tick(time, State(10), reading=5))
    with pytest.raises(DeviceError, match="pan rests at 5, not 10"):
        program.result()


def test_a_jog_ends_with_a_stop(program):
    program.submit(JogJob({Axis.PAN: 4}, 1))
    assert program.read(0.0, AT_REST)[0] == {Axis.PAN: VelocityTarget(4)}
    assert program.read(1.0, AT_REST)[0] == {Axis.PAN: Stop()}


def test_one_job_at_a_time(program):
    program.submit(JogJob({Axis.PAN: 4}, 1))
    with pytest.raises(BusyError, match="busy"):
        program.submit(JogJob({Axis.PAN: 4}, 1))


def test_a_stop_ends_the_job_once_every_axis_rests_and_latches(program):
    program.submit(JogJob({Axis.PAN: 4}, 1))
    program.read(0.0, AT_REST)
    program.stop()
    assert program.read(0.1, AT_REST)[0] == {Axis.PAN: Stop()}
    program.observe(tick(0.1, State(0, 4)))
    assert not program.finished
    program.observe(tick(0.2, State(0.4)))
    with pytest.raises(StoppedError):
        program.result()
    with pytest.raises(StoppedError, match=r"clear\(\)"):
        program.submit(JogJob({Axis.PAN: 4}, 1))
    program.clear()
    program.submit(JogJob({Axis.PAN: 4}, 1))


def test_an_event_passes_a_stop_and_waits_for_its_answer(program):
    waiting = [True]
    program.stop()
    program.submit(EventJob(Action.STOP, lambda: waiting[0]))
    demand, events = program.read(0.0, AT_REST)
    assert (demand, list(events)) == ({Axis.PAN: Stop()}, [Action.STOP])
    program.observe(tick(0.0, State(0)))
    assert not program.finished
    waiting.clear()
    waiting.append(False)
    program.observe(tick(0.1, State(0)))
    assert program.finished


def test_the_end_of_the_run_ends_a_job_and_takes_no_other(program):
    program.submit(JogJob({Axis.PAN: 4}, 1))
    program.end(DeviceError("the gimbal is silent"))
    with pytest.raises(DeviceError, match="silent"):
        program.result()
    with pytest.raises(TeleopError, match="the run has ended: the gimbal is silent; open the rig again"):
        program.submit(JogJob({Axis.PAN: 4}, 1))
