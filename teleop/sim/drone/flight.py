"""How a simulated drone flies: simple, honest, and exact in time.

Between two commands everything is a closed form of time. Speeds follow what is asked with a first-order lag, along the
drone's own nose or along north; the attitude is the one that such an acceleration needs; heading turns at a constant
rate (see segments). What happens by itself (touching the ground, reaching a heading) has a time that is
worked out when the flight is asked for a later one, so looking often or seldom makes no difference.

It has no wind, no ground effect and no battery sag; motors that are cut in the air let it fall.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from teleop.sim.drone.segments import GRAVITY, LAG, Climb, Level

DRAG_LAG = 3.0  # s: of the speed that a tilt comes to, which only the air holds
TURN = math.radians(100)  # rad/s at which a heading is sought
APPROACH = 1.5  # s: time constant of a position or a height that is sought
CRASH = 4.0  # m/s downwards: what hits the ground faster than this is broken


class Pose(NamedTuple):
    """Where the drone is and how it moves: m north, east and up of where it started, m/s, rad."""

    north: float
    east: float
    height: float
    velocity_north: float
    velocity_east: float
    climb: float
    roll: float
    pitch: float
    yaw: float
    yaw_rate: float


@dataclass
class Flight:
    """A drone standing on the ground at `time`, its nose to `yaw` (rad from north to east), motors off."""

    time: float
    yaw: float = 0.0
    motors: bool = False
    airborne: bool = False
    crashed: bool = False
    landed: float = -math.inf  # s: when it last touched down
    _level: Level = field(default_factory=Level)
    _climb: Climb = field(default_factory=Climb)
    _turn: float = 0.0  # rad/s of the nose since `_turned`
    _turned: float = 0.0
    _turn_end: float = math.inf

    def __post_init__(self) -> None:
        self._turned = self.time
        self._level = replace(self._level, start=self.time)
        self._climb = replace(self._climb, start=self.time)

    def pose(self) -> Pose:
        """At the time that it has been passed to."""
        time, level = self.time, self._level
        place, velocity = level.at(time), level.velocity(time)
        yaw = self._heading(time)
        tilt = level.tilt
        if tilt is None:
            push = level.acceleration(time) * level.frame(time) * cmath.exp(-1j * yaw) / GRAVITY
            tilt = complex(math.atan(push.real), math.atan(push.imag)) if self.airborne else 0j
        return Pose(
            place.real,
            place.imag,
            max(0.0, self._climb.at(time)),
            velocity.real,
            velocity.imag,
            self._climb.rate(time) if self.airborne else 0.0,
            tilt.imag,
            -tilt.real,
            math.remainder(yaw, math.tau),
            self._turn,
        )

    def pass_to(self, now: float) -> None:
        """Let time pass until `now` (s, never going back), and what it brings with it."""
        while True:
            touchdown = self.touchdown(now)
            event = min(touchdown, self._turn_end)
            if event > now:
                break
            self.time = max(self.time, event)
            if event == touchdown:
                self._touch_down()
            else:
                self._point(0.0, math.inf)
        self.time = max(self.time, now)

    def touchdown(self, now: float) -> float:
        """When until `now` it comes down, if nothing else is asked of it; inf for not yet."""
        return self._climb.touchdown(now) if self.airborne else math.inf

    def fly(self, velocity: complex, *, to_north: bool = False, lag: float = LAG, tilt: complex | None = None) -> None:
        """Take up a horizontal velocity (m/s): forward and right, or with `to_north` north and east."""
        if not self.airborne or not self.motors:
            return
        heading, turn = (0.0, 0.0) if to_north else (self._heading(self.time), self._turn)
        here, now = self._level.at(self.time), self._level.velocity(self.time)
        first = now * cmath.exp(-1j * heading)
        self._level = Level(self.time, here, first, velocity, lag, heading, turn, tilt, to_north)

    def lean(self, forward: float, right: float, *, to_north: bool = False) -> None:
        """Tilt by so many rad; the air alone says what speed that comes to."""
        speed = complex(math.tan(forward), math.tan(right)) * GRAVITY * DRAG_LAG
        tilt = complex(forward, right)
        if to_north:
            tilt *= cmath.exp(-1j * self._heading(self.time))
        self.fly(speed, to_north=to_north, lag=DRAG_LAG, tilt=tilt)

    def seek(self, offset: complex, *, to_north: bool = False) -> None:
        """Go to a place so many m from here, and stop there."""
        self.fly(0j, to_north=to_north, lag=APPROACH)
        if self.airborne:
            self._level = replace(self._level, first=offset / APPROACH)

    def climb(self, rate: float) -> None:
        """Take up a climb (m/s, up is positive); from the ground, take off with it if the motors turn."""
        if not self.motors or not (self.airborne or rate > 0):
            return
        self.airborne = True
        height, now = max(0.0, self._climb.at(self.time)), self._climb.rate(self.time)
        self._climb = Climb(self.time, height, now, rate)

    def rise_to(self, height: float) -> None:
        """Seek a height (m)."""
        here = self._climb.at(self.time)
        self.climb((height - here) / APPROACH)
        if self.airborne:
            self._climb = Climb(self.time, max(0.0, here), (height - here) / APPROACH, 0.0, APPROACH)

    def turn(self, rate: float) -> None:
        """Turn the nose at so many rad/s, to the right when positive."""
        self._point(rate if self.airborne else 0.0, math.inf)

    def face(self, yaw: float) -> None:
        """Turn the nose to `yaw`, the shorter way."""
        way = math.remainder(yaw - self._heading(self.time), math.tau)
        if self.airborne and way:
            self._point(math.copysign(TURN, way), self.time + abs(way) / TURN)

    def hover(self, height: float) -> None:
        """It has been flown up to `height` (m) before, and stands still there."""
        self.motors = self.airborne = True
        self._climb = Climb(self.time, height)

    def start_motors(self) -> None:
        self.motors = not self.crashed

    def stop_motors(self) -> None:
        """On the ground it stays there; in the air it falls."""
        self.motors = False
        if self.airborne:
            self._climb = Climb(self.time, self._climb.at(self.time), self._climb.rate(self.time), 0.0, falling=True)

    def _heading(self, time: float) -> float:
        return self.yaw + self._turn * (time - self._turned)

    def _point(self, rate: float, end: float) -> None:
        if rate == self._turn and end == self._turn_end:
            return
        self.yaw, self._turned = self._heading(self.time), self.time
        self._turn, self._turn_end = rate, end
        level = self._level
        if not level.to_north:  # a velocity that is held along the nose turns with it
            self.fly(level.last, lag=level.lag, tilt=level.tilt)

    def _touch_down(self) -> None:
        self.crashed |= self._climb.rate(self.time) < -CRASH
        self.motors = self.motors and not self.crashed
        self.airborne, self.landed = False, self.time
        self._turn_end = math.inf
        self.yaw, self._turned, self._turn = self._heading(self.time), self.time, 0.0
        self._level = Level(self.time, self._level.at(self.time))
        self._climb = Climb(self.time)
