"""Who flies a simulated drone, and what it does by itself: the rules of the autopilot, apart from any protocol.

The real RC has the drone unless virtual RC is on or the onboard computer was given control, and its mode switch takes
both away. Virtual RC lasts while sticks come: a second without any ends it, back to the real RC or into the logic for
an RC that is lost, as the one who enabled it chose (Virtual RC page, note 1). Enabling it twice within 2 s locks
the drone in a check loop that its RC cannot end (docs/protocol-facts.md). The gesture that starts the motors on the
ground cuts them in the air.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from teleop.sim.drone.controls import Controls, Pilot, Status, Switch, TaskState
from teleop.sim.drone.flight import Flight, Pose
from teleop.sim.drone.hand import Hand
from teleop.sim.drone.settings import M100, DroneSettings
from teleop.sim.drone.tasks import FINISHING, Automatic, Due

LOCKS_WITHIN = 2.0  # s between two enables
GESTURE = 1.0  # s that the sticks are to be in the corners
SPEED, CLIMB, TILT, YAW = 10.0, 4.0, math.radians(30), math.radians(100)  # of a full stick
FULL, IDLE = 100 / (18 * 60), 100 / (80 * 60)  # % of the battery a second, in the air and with idle motors


class Autopilot:
    """A drone on the ground at `now`, its RC's mode switch in F as it is for flying from a computer."""

    def __init__(self, now: float, yaw: float = 0.0, battery: float = 100.0, settings: DroneSettings = M100) -> None:
        self.flight = Flight(now, yaw)
        self.hand = Hand()
        self._automatic = Automatic(self.flight)
        self._settings = settings
        self.rc = Controls(switch=Switch.F)
        self.virtual = Controls()
        self.pilot = Pilot.RC
        self.virtual_on = self.locked = self.obtained = False
        self.control_lost = 0  # how often it was taken from the onboard computer
        self._back_to_rc = True
        self._enabled = self._last_sticks = self._last_move = -math.inf
        self._in_corners = math.inf  # since when the sticks in control are
        self._gesture_made = False  # and have not left them since
        self._battery = battery

    @property
    def task(self) -> TaskState:
        """Of what it does by itself, or did last."""
        return self._automatic.state

    @property
    def time(self) -> float:
        return self.flight.time

    @property
    def pose(self) -> Pose:
        pose = self.flight.pose()
        return pose if self.flight.motors else self.hand.held(pose, self.time)

    @property
    def rates(self) -> tuple[float, float, float]:
        """Of roll, pitch and yaw, rad/s."""
        roll, pitch = (0.0, 0.0) if self.flight.motors else self.hand.rates(self.time)[:2]
        return roll, pitch, self.pose.yaw_rate

    @property
    def battery(self) -> float:
        """Per cent."""
        return self._battery

    @property
    def status(self) -> Status:
        if self.flight.airborne:
            return Status.LANDING if self._automatic.doing is Status.LANDING else Status.IN_AIR
        if self.time < self.flight.landed + FINISHING:
            return Status.FINISH_LANDING
        return Status.TAKE_OFF if self._automatic.doing is Status.TAKE_OFF else Status.STANDBY

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
                self._automatic.touch_down()
            if act and due <= until:
                act()

    def _due(self) -> list[Due]:
        due = self._automatic.due()
        if self.virtual_on and not self.locked:
            due.append((self._last_sticks + self._settings.virtual_rc_timeout, self._virtual_timeout))
        if self.pilot is Pilot.ONBOARD and self._last_move > -math.inf:
            due.append((self._last_move + self._settings.movement_timeout, self._move_timeout))
        if self._in_corners < math.inf:
            due.append((self._in_corners + GESTURE, self._gesture))
        return due

    def enable_virtual(self, back_to_rc: bool) -> None:
        if self.time - self._enabled < LOCKS_WITHIN:
            self.locked = True
        self._enabled = self.time
        if self.rc.switch is Switch.F and not self.locked:
            self.virtual_on, self._back_to_rc, self._last_sticks = True, back_to_rc, self.time
            self.virtual = Controls()
            self._hand_to(Pilot.VIRTUAL)

    def disable_virtual(self, back_to_rc: bool) -> None:
        if self.virtual_on and not self.locked:
            self._end_virtual(back_to_rc)

    def virtual_sticks(self, controls: Controls) -> None:
        if self.virtual_on and not self.locked:
            self._last_sticks = self.time
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
        """Take control from the onboard computer, and notify it."""
        if self.obtained:
            self.control_lost += 1
            self.release()

    def moves(self, move: Callable[[Flight], object]) -> None:
        """A movement command of the onboard computer."""
        if self.pilot is Pilot.ONBOARD:
            self._last_move = self.time
            self._automatic.interrupt()
            move(self.flight)

    def take_off(self) -> bool:
        """Whether it does; see Automatic for each of the three."""
        return self._does(self._automatic.take_off)

    def land(self) -> bool:
        return self._does(self._automatic.land)

    def go_home(self) -> bool:
        return self._does(self._automatic.go_home)

    def _does(self, task: Callable[[], bool]) -> bool:
        """A task holds against the end of movement commands that came before it."""
        starts = task()
        if starts:
            self._last_move = -math.inf
        return starts

    def _hand_to(self, pilot: Pilot) -> None:
        self.pilot = pilot
        self._last_move, self._in_corners = -math.inf, math.inf
        if pilot is Pilot.RC:
            self._obey(self.rc)
        elif self._automatic.doing is None:
            self._automatic.hover()

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
        self._last_move = -math.inf
        self._automatic.hover()

    def _obey(self, controls: Controls) -> None:
        if controls.in_corners:
            self._in_corners = math.inf if self._gesture_made else min(self._in_corners, self.time)
            return
        self._in_corners, self._gesture_made = math.inf, False
        if self._automatic.doing is not None and not (
            controls.roll or controls.pitch or controls.throttle or controls.yaw
        ):
            return  # a task in progress is not interrupted
        self._automatic.interrupt()
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
