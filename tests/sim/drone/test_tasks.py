"""What a simulated drone does by itself, and how each task ends."""

from __future__ import annotations

import math

import pytest

from teleop.sim.drone.controls import Status, TaskState
from teleop.sim.drone.flight import Flight
from teleop.sim.drone.tasks import Automatic


class Bench:
    def __init__(self, height: float = 0.0) -> None:
        self.flight = Flight(0.0)
        if height:
            self.flight.hover(height)
        self.automatic = Automatic(self.flight)

    def run(self, seconds: float) -> None:
        end = self.flight.time + seconds
        while self.flight.time < end:
            due, act = min(self.automatic.due(), default=(math.inf, None))
            until = min(due, end, self.flight.touchdown(end))
            airborne = self.flight.airborne
            self.flight.pass_to(until)
            if airborne and not self.flight.airborne:
                self.automatic.touch_down()
            if act and due <= until:
                act()


def test_a_take_off_ends_in_the_air() -> None:
    bench = Bench()
    assert bench.automatic.take_off()
    assert (bench.automatic.doing, bench.automatic.state) == (Status.TAKE_OFF, TaskState.RUNNING)
    bench.run(20)
    assert (bench.automatic.doing, bench.automatic.state) == (None, TaskState.SUCCEEDED)
    assert bench.flight.pose().height == pytest.approx(1.2, abs=0.05)


def test_it_takes_off_only_with_the_motors_off() -> None:
    bench = Bench()
    bench.flight.start_motors()
    assert not bench.automatic.take_off()
    assert not Bench(5.0).automatic.take_off()
    assert bench.automatic.state is TaskState.NONE


def test_it_neither_lands_nor_returns_on_the_ground() -> None:
    bench = Bench()
    assert not bench.automatic.land()
    assert not bench.automatic.go_home()
    assert bench.automatic.state is TaskState.NONE


def test_a_landing_ends_with_the_motors_off_2_s_after_it_touched_down() -> None:
    bench = Bench(3.0)
    assert bench.automatic.land()
    bench.run(3.0)
    assert bench.automatic.doing is Status.LANDING
    while bench.flight.airborne:
        bench.run(0.1)
    bench.run(1.8)
    assert (bench.flight.motors, bench.automatic.state) == (True, TaskState.RUNNING)
    bench.run(0.3)
    assert (bench.flight.motors, bench.automatic.state) == (False, TaskState.SUCCEEDED)


def test_it_returns_to_where_it_took_off_and_lands_there() -> None:
    bench = Bench(10.0)
    bench.flight.fly(5 + 2j, to_north=True)
    bench.run(6)
    assert abs(bench.flight.pose().north) > 20
    assert bench.automatic.go_home()
    bench.run(60)
    pose = bench.flight.pose()
    assert (pose.north, pose.east) == (pytest.approx(0, abs=0.2), pytest.approx(0, abs=0.2))
    assert (bench.flight.airborne, bench.automatic.state) == (False, TaskState.SUCCEEDED)


def test_a_task_that_is_flown_over_has_failed() -> None:
    bench = Bench(10.0)
    bench.automatic.land()
    bench.automatic.interrupt()
    assert (bench.automatic.doing, bench.automatic.state) == (None, TaskState.FAILED)
    assert bench.automatic.due() == []
