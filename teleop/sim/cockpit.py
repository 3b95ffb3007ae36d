"""Who flies a simulated drone, and what it does by itself: the rules of the autopilot, apart from any protocol.

The real RC has the drone unless virtual RC is on or the onboard computer was given control, and its mode switch takes
both away. Virtual RC lasts while sticks come: a second without any ends it, back to the real RC or into the logic for
an RC that is lost, as the one who enabled it chose (virtual-rc.md, note 1). Enabling it twice within two seconds locks
the drone in a check loop that its RC cannot end (osdk-facts.md, Safety). The gesture that starts the motors on the
ground cuts them in the air.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from teleop.sim.controls import Controls, Pilot, Status, Switch, TaskState
from teleop.sim.drone_settings import M100, DroneSettings
from teleop.sim.flight import APPROACH, Flight, Pose

LOCKS_WITHIN = 2.0  # s between two enables
GESTURE = 1.0  # s that the sticks are to be in the corners
SPIN_UP = 1.0  # s from starting motors to lifting off by itself
SPEED, CLIMB, TILT, YAW = 10.0, 4.0, math.radians(30), math.radians(100)  # of a full stick
TAKE_OFF_HEIGHT, LANDING, HOME_SPEED = 1.2, -1.0, 5.0  # m, m/s, m/s
RISEN = 4.0  # time constants after which a height is reached
FINISHING = 2.0  # s from touching down to standby: osdk-appendix.md, Flight status
FULL, IDLE = 100 / (18 * 60), 100 / (80 * 60)  # % of the battery a second, in the air and with idle motors


class Cockpit:
    """A drone on the ground at `now`, its RC's mode switch in F as it is for flying from a computer."""

    def __init__(self, now: float, yaw: float = 0.0, battery: float = 100.0, settings: DroneSettings = M100) -> None:
        self.flight = Flight(now, yaw)
        self.task = TaskState.NONE  # of what it does by itself, or did last
        self._settings = settings
        self.rc = Controls(switch=Switch.F)
        self.virtual = Controls()
        self.pilot = Pilot.RC
        self.virtual_on = self.locked = self.obtained = False
        self.control_lost = 0  # how often it was taken from the onboard computer
        self._back_to_rc = True
        self._enabled = self._stick_heard = self._move_heard = -math.inf
        self._in_corners = math.inf  # since when the sticks of whoever flies are
        self._gesture_made = False  # and have not left them since
        self._battery = battery
        self._plan: list[tuple[float, Callable[[], object]]] = []  # what it does by itself, and when
        self._auto: Status | None = None

    @property
    def time(self) -> float:
        return self.flight.time

    @property
    def pose(self) -> Pose:
        return self.flight.pose()

    @property
    def battery(self) -> float:
        """Per cent."""
        return self._battery

    @property
    def status(self) -> Status:
        if self.flight.airborne:
            return Status.LANDING if self._auto is Status.LANDING else Status.IN_AIR
        if self.time < self.flight.landed + FINISHING:
            return Status.FINISH_LANDING
        return Status.TAKE_OFF if self._auto is Status.TAKE_OFF else Status.STANDBY

    def pass_to(self, now: float) -> None:
        """Let time pass until `now` (s), and do what falls due meanwhile, each at its own time."""
        while self.time < now:
            due, act = min(self._due(), key=lambda each: each[0], default=(math.inf, None))
            until = max(self.time, min(due, now, self.flight.touchdown(now)))
            before, airborne = self.time, self.flight.airborne
            self.flight.pass_to(until)
            spent = FULL if airborne else IDLE if self.flight.motors else 0.0
            self._battery = max(0.0, self._battery - spent * (until - before))
            if airborne and not self.flight.airborne:
                self._plan = [(self.flight.landed + FINISHING, self._finish_landing)]
            if act and due <= until:
                act()

    def _due(self) -> list[tuple[float, Callable[[], object]]]:
        due: list[tuple[float, Callable[[], object]]] = [(time, self._go_on) for time, _ in self._plan[:1]]
        if self.virtual_on and not self.locked:
            due.append((self._stick_heard + self._settings.virtual_rc_timeout, self._virtual_timeout))
        if self.pilot is Pilot.ONBOARD and self._move_heard > -math.inf:
            due.append((self._move_heard + self._settings.movement_timeout, self._move_timeout))
        if self._in_corners < math.inf:
            due.append((self._in_corners + GESTURE, self._gesture))
        return due

    def enable_virtual(self, back_to_rc: bool) -> None:
        if self.time - self._enabled < LOCKS_WITHIN:
            self.locked = True
        self._enabled = self.time
        if self.rc.switch is Switch.F and not self.locked:
            self.virtual_on, self._back_to_rc, self._stick_heard = True, back_to_rc, self.time
            self.virtual = Controls()
            self._hand_to(Pilot.VIRTUAL)

    def disable_virtual(self, back_to_rc: bool) -> None:
        if self.virtual_on and not self.locked:
            self._end_virtual(back_to_rc)

    def virtual_sticks(self, controls: Controls) -> None:
        if self.virtual_on and not self.locked:
            self._stick_heard = self.time
            self.virtual = controls
            self._obey(controls)

    def real_rc(self, controls: Controls) -> None:
        """The pilot's hands: leaving F takes the drone back, unless it is locked."""
        self.rc = controls
        if controls.switch is not Switch.F and not self.locked:
            if self.virtual_on:
                self._end_virtual(back_to_rc=True)
            self.lose_control()
        if self.pilot is Pilot.RC:
            self._obey(controls)

    @property
    def may_obtain(self) -> bool:
        """Whether its RC lets the onboard computer have control."""
        return self.rc.switch is Switch.F and not self.locked

    def obtain(self) -> bool:
        """Give the onboard computer control; whether its RC allows it."""
        if not self.may_obtain:
            return False
        self.obtained = True
        if self.pilot is Pilot.RC:
            self._hand_to(Pilot.ONBOARD)
        return True

    def release(self) -> None:
        self.obtained = False
        if self.pilot is Pilot.ONBOARD:
            self._hand_to(Pilot.RC)

    def lose_control(self) -> None:
        """Take control from the onboard computer, which is told."""
        if self.obtained:
            self.control_lost += 1
            self.release()

    def moves(self, move: Callable[[Flight], object]) -> None:
        """A movement command of the onboard computer."""
        if self.pilot is Pilot.ONBOARD:
            self._move_heard = self.time
            self._by_itself(None)
            move(self.flight)

    def take_off(self) -> bool:
        """Whether it does: only with the motors off, so not within two seconds of a landing (OSDK-ROS issue 213)."""
        if self.flight.airborne or self.flight.motors or self.flight.crashed:
            return False
        self._begin(Status.TAKE_OFF)
        self.flight.start_motors()
        lift_off = self.time + SPIN_UP
        self._plan = [(lift_off, self._lift_off), (lift_off + RISEN * APPROACH, self._finish_task)]
        return True

    def land(self) -> bool:
        """Whether it does: not on the ground (the maker's sample LinuxFlight.cpp, landing)."""
        if not self.flight.airborne:
            return False
        self._begin(Status.LANDING)
        self._descend()
        return True

    def go_home(self) -> bool:
        """In a straight line to where it took off, and down; whether it does, which is not on the ground."""
        if not self.flight.airborne:
            return False
        self._begin(Status.IN_AIR)
        self._hover()
        way = -complex(self.pose.north, self.pose.east)
        seconds = abs(way) / HOME_SPEED
        if seconds:
            self.flight.fly(way / seconds, to_north=True)
        arrive, land = self.time + seconds, self.time + seconds + 5.0
        self._plan = [(arrive, self._seek_home), (land, self._descend)]
        return True

    def _lift_off(self) -> None:
        self.flight.rise_to(TAKE_OFF_HEIGHT)

    def _descend(self) -> None:
        self._auto = Status.LANDING
        self._hover()
        self.flight.climb(LANDING)

    def _begin(self, doing: Status) -> None:
        """A task holds against the end of movement commands that came before it."""
        self._by_itself(doing)
        self.task = TaskState.RUNNING
        self._move_heard = -math.inf

    def _seek_home(self) -> None:
        self.flight.seek(-complex(self.pose.north, self.pose.east), to_north=True)

    def _by_itself(self, doing: Status | None) -> None:
        if self.task is TaskState.RUNNING:
            self.task = TaskState.FAILED
        self._auto, self._plan = doing, []

    def _finish_task(self) -> None:
        self.task = TaskState.SUCCEEDED
        self._auto = None

    def _go_on(self) -> None:
        _, act = self._plan.pop(0)
        act()

    def _finish_landing(self) -> None:
        self.flight.stop_motors()
        if self.task is TaskState.RUNNING:
            self.task = TaskState.SUCCEEDED
        self._auto = None

    def _hover(self) -> None:
        self.flight.fly(0j)
        self.flight.climb(0.0)
        self.flight.turn(0.0)

    def _hand_to(self, pilot: Pilot) -> None:
        self.pilot = pilot
        self._move_heard, self._in_corners = -math.inf, math.inf
        if pilot is Pilot.RC:
            self._obey(self.rc)
        elif self._auto is None:
            self._hover()

    def _end_virtual(self, back_to_rc: bool) -> None:
        self.virtual_on = False
        if back_to_rc:
            self._hand_to(Pilot.ONBOARD if self.obtained else Pilot.RC)
        else:
            self._hand_to(Pilot.NOBODY)
            self.go_home()

    def _virtual_timeout(self) -> None:
        self._end_virtual(self._back_to_rc)

    def _move_timeout(self) -> None:
        self._move_heard = -math.inf
        self._hover()

    def _obey(self, controls: Controls) -> None:
        if controls.in_corners:
            self._in_corners = math.inf if self._gesture_made else min(self._in_corners, self.time)
            return
        self._in_corners, self._gesture_made = math.inf, False
        if self._auto is not None and not (controls.roll or controls.pitch or controls.throttle or controls.yaw):
            return  # nobody interferes with what it does by itself
        self._by_itself(None)
        flight = self.flight
        if controls.switch is Switch.A:
            flight.lean(controls.pitch * TILT, controls.roll * TILT)
        else:
            flight.fly(complex(controls.pitch, controls.roll) * SPEED)
        flight.climb(controls.throttle * CLIMB)
        flight.turn(controls.yaw * YAW)

    def _gesture(self) -> None:
        """The sticks have been in the corners for long enough: on the ground the motors start or stop."""
        self._in_corners, self._gesture_made = math.inf, True
        if self.flight.motors:
            self.flight.stop_motors()
        else:
            self.flight.start_motors()

    def set_battery(self, percent: float) -> None:
        self._battery = percent

    def turn_switch(self, switch: Switch) -> None:
        """The pilot turns the RC's mode switch."""
        self.real_rc(replace(self.rc, switch=switch))
