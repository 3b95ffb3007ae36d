"""What a simulated drone does by itself: take off, land, return home, each a plan of acts at times of its own."""

from __future__ import annotations

from collections.abc import Callable

from teleop.sim.drone.controls import Status, TaskState
from teleop.sim.drone.flight import APPROACH, Flight

SPIN_UP = 1.0  # s from starting motors to lifting off by itself
TAKE_OFF_HEIGHT, LANDING, HOME_SPEED = 1.2, -1.0, 5.0  # m, m/s, m/s
HOVERS_ABOVE_HOME = 5.0  # s
RISEN = 4.0  # time constants after which a height is reached
FINISHING = 2.0  # s from touching down to standby: Appendix.md, Flight status

Due = tuple[float, Callable[[], object]]


class Automatic:
    """`doing` is the status of what it does now, None for nothing; `state` is of the task that it has or had last."""

    def __init__(self, flight: Flight) -> None:
        self.doing: Status | None = None
        self.state = TaskState.NONE
        self._flight = flight
        self._plan: list[Due] = []

    def due(self) -> list[Due]:
        """The next act, and when."""
        return [(time, self._act) for time, _ in self._plan[:1]]

    def interrupt(self) -> None:
        """It is flown: it does nothing by itself any more."""
        self._begin(None)

    def touch_down(self) -> None:
        """It has come to the ground, by itself or not."""
        self._plan = [(self._flight.landed + FINISHING, self._stop_motors)]

    def take_off(self) -> bool:
        """Whether it does: only with the motors off, so not within two seconds of a landing (OSDK-ROS issue 213)."""
        flight = self._flight
        if flight.airborne or flight.motors or flight.crashed:
            return False
        self._begin(Status.TAKE_OFF)
        flight.start_motors()
        lift_off = flight.time + SPIN_UP
        self._plan = [(lift_off, self._lift_off), (lift_off + RISEN * APPROACH, self._finish)]
        return True

    def land(self) -> bool:
        """Whether it does: not on the ground (the maker's sample LinuxFlight.cpp, landing)."""
        if not self._flight.airborne:
            return False
        self._begin(Status.LANDING)
        self._descend()
        return True

    def go_home(self) -> bool:
        """In a straight line to where it took off, and down; whether it does, which is not on the ground."""
        flight = self._flight
        if not flight.airborne:
            return False
        self._begin(Status.IN_AIR)
        self.hover()
        way = self._way_home()
        seconds = abs(way) / HOME_SPEED
        if seconds:
            flight.fly(way / seconds, to_north=True)
        arrive = flight.time + seconds
        self._plan = [(arrive, self._seek_home), (arrive + HOVERS_ABOVE_HOME, self._descend)]
        return True

    def hover(self) -> None:
        self._flight.fly(0j)
        self._flight.climb(0.0)
        self._flight.turn(0.0)

    def _begin(self, doing: Status | None) -> None:
        if self.state is TaskState.RUNNING:
            self.state = TaskState.FAILED
        if doing:
            self.state = TaskState.RUNNING
        self.doing, self._plan = doing, []

    def _act(self) -> None:
        _, act = self._plan.pop(0)
        act()

    def _finish(self) -> None:
        if self.state is TaskState.RUNNING:
            self.state = TaskState.SUCCEEDED
        self.doing = None

    def _stop_motors(self) -> None:
        self._flight.stop_motors()
        self._finish()

    def _lift_off(self) -> None:
        self._flight.rise_to(TAKE_OFF_HEIGHT)

    def _descend(self) -> None:
        self.doing = Status.LANDING
        self.hover()
        self._flight.climb(LANDING)

    def _way_home(self) -> complex:
        pose = self._flight.pose()
        return -complex(pose.north, pose.east)

    def _seek_home(self) -> None:
        self._flight.seek(self._way_home(), to_north=True)
