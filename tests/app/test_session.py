"""A rig that a program has opened: jobs in its control loop, closed once whatever happens, and then refused."""

from __future__ import annotations

import sys
import threading

import pytest

from teleop.app.program import MoveJob
from teleop.app.session import Session
from teleop.app.switch_interval import SWITCH_INTERVAL
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError, TeleopError, UsageError
from teleop.core.events import Tick


@pytest.fixture
def session():
    opened = Session(load_profile("sim"), virtual=True)
    yield opened
    opened.close()


class Interrupting:
    """An observer in which the program's Ctrl-C arrives, once."""

    def __init__(self) -> None:
        self.at: float | None = None
        self.last: Tick | None = None

    def observe(self, tick: Tick) -> None:
        self.last = tick
        if self.at is None and tick.motion[Axis.PAN].velocity > 10:
            self.at = tick.time
            raise KeyboardInterrupt


def test_a_job_is_run_to_its_end(session: Session):
    session.run(MoveJob({Axis.PAN: 10}, None))
    assert session.program.tick is not None
    assert session.program.tick.motion[Axis.PAN].position == pytest.approx(10)
    assert not session.over


def test_a_closed_rig_refuses_jobs_and_may_be_closed_again(session: Session):
    session.close()
    session.close()
    assert session.over
    with pytest.raises(TeleopError, match="the rig is closed"):
        session.run(MoveJob({Axis.PAN: 10}, None))


def test_a_run_that_has_ended_says_why(session: Session):
    assert session._loop is not None
    session._loop.interrupt("a test")
    with pytest.raises(DeviceError, match="a test"):
        session.run(MoveJob({Axis.PAN: 10}, None))
    with pytest.raises(DeviceError, match="the run has ended: a test; open the rig again"):
        session.check()


def test_a_ctrl_c_while_the_loop_turns_brings_the_axes_to_rest_and_is_raised_once(session: Session):
    watch = Interrupting()
    with pytest.raises(KeyboardInterrupt):
        session.run(MoveJob({Axis.PAN: 90}, None), [watch])
    assert watch.last is not None
    assert session.over
    session.close()  # not raised again
    assert session.reason.startswith("interrupted")


def test_in_real_time_a_thread_turns_the_loop_until_it_is_closed():
    before = sys.getswitchinterval()
    session = Session(load_profile("sim"), virtual=False)
    try:
        assert [each.name for each in threading.enumerate()].count("teleop control") == 1
        assert sys.getswitchinterval() == pytest.approx(SWITCH_INTERVAL)
    finally:
        session.close()
    assert "teleop control" not in [each.name for each in threading.enumerate()]
    assert sys.getswitchinterval() == before


def test_a_rig_of_sticks_alone_needs_an_operator():
    profile = load_profile("sim-drone")
    sticks = {name: each for name, each in profile.axes.items() if name.startswith("stick_")}
    with pytest.raises(UsageError, match="no axis that a program can move"):
        Session(profile.model_copy(update={"axes": sticks}), virtual=True)
