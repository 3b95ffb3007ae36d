"""What a simulated drone says of itself, unasked: parts of the broadcast at the rates they were set to.

Rates divide 100 Hz, so every part falls on a beat of one clock of 10 ms that began with the broadcast, and the parts
of a beat share a frame. Values are the flight model's at the time of the beat, not of the look.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from teleop.dji.drone.broadcast import Broadcast
from teleop.dji.drone.broadcast_parts import (
    Acceleration,
    AngularRate,
    ControlSource,
    Magnetometer,
    Position,
    Quaternion,
    Rc,
    Time,
    Velocity,
)
from teleop.dji.drone.enums import ControlDevice, CurrentMode, FlightStatus, Rate, RcGear, RcMode
from teleop.dji.drone.messages import Frequency
from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.controls import Controls, Pilot, Switch
from teleop.sim.drone.flight import Pose
from teleop.sim.drone.payload import Payload
from teleop.sim.drone.settings import M100, DroneSettings
from teleop.sim.gimbal.pushes import Beat

BEAT = 0.01  # s
EVERY: Mapping[Rate, int] = {Rate.HZ_1: 100, Rate.HZ_10: 10, Rate.HZ_50: 2, Rate.HZ_100: 1}  # beats
DEFAULTS: Mapping[str, Rate] = {  # Appendix.md, Flight Data
    **dict.fromkeys(("time", "quaternion", "acceleration", "velocity", "angular_rate", "position"), Rate.HZ_100),
    "magnetometer": Rate.OFF,
    "rc": Rate.HZ_50,
    "gimbal": Rate.HZ_50,
    "status": Rate.HZ_10,
    "battery": Rate.HZ_1,
    "control": Rate.OFF,
}
HOME = math.radians(52.5), math.radians(13.4)  # latitude, longitude
ALTITUDE = 40.0  # m above sea
EARTH = 6_371_000.0  # m
MODES: Mapping[Switch, RcMode] = {Switch.P: RcMode.P, Switch.A: RcMode.A, Switch.F: RcMode.F}


class TelemetrySender:
    """`hidden` are parts that are not sent though they were asked for, `health` is the GPS's (0..5).

    `mirrors`: whether the RC that is broadcast is the virtual one while that flies; what real ones do is not known.
    """

    def __init__(self, mirrors: bool, health: int, settings: DroneSettings = M100) -> None:
        self.rates = dict(DEFAULTS)
        self.hidden: Collection[str] = ()
        self.health = health
        self.mode = CurrentMode.ATTI_STOP
        self._mirrors, self._settings = mirrors, settings
        self._beat: Beat | None = None

    def begin(self, now: float) -> None:
        self._beat = self._beat or Beat(now, BEAT)

    def end(self) -> None:
        """The drone goes out; all is then as at first."""
        self._beat, self.rates = None, dict(DEFAULTS)

    def set(self, frequency: Frequency) -> None:
        wanted = {part: Rate(getattr(frequency, part)) for part in self.rates}
        self.rates |= {part: rate for part, rate in wanted.items() if rate is not Rate.HOLD}

    def due(self, now: float) -> list[tuple[float, Collection[str]]]:
        """The times since the last call at which something is sent, and the parts."""
        if self._beat is None:
            return []
        times = self._beat.due(now)
        first = self._beat.done - len(times) + 1
        beats = [(time, self._parts(first + index)) for index, time in enumerate(times)]
        return [(time, parts) for time, parts in beats if parts]

    def _parts(self, beat: int) -> Collection[str]:
        return [
            part
            for part, rate in self.rates.items()
            if rate in EVERY and beat % EVERY[rate] == 0 and part not in self.hidden
        ]

    def notify(self, autopilot: Autopilot, payload: Payload, parts: Collection[str]) -> Broadcast:
        """These parts of the broadcast as they are now.

        Vertical velocity is up: the 3.1.9 sample takeoffConverged waits for v.z > 0.25 (docs/protocol-facts.md).
        """
        pose, signs = autopilot.pose, self._settings
        rates = (sign * rate for sign, rate in zip(signs.rate_signs, autopilot.rates, strict=True))
        turned = (
            sign * angle for sign, angle in zip(signs.attitude_signs, (pose.roll, pose.pitch, pose.yaw), strict=True)
        )
        whole = {
            "time": lambda: Time(round(autopilot.time * 400) & 0xFFFFFFFF, round(autopilot.time % 1 * 1e9), 0),
            "quaternion": lambda: quaternion(*turned),
            "acceleration": lambda: Acceleration(0.0, 0.0, 0.0),
            "velocity": lambda: Velocity(pose.velocity_north, pose.velocity_east, signs.climb_sign * pose.climb),
            "angular_rate": lambda: AngularRate(*rates),
            "position": lambda: self._position(pose),
            "magnetometer": lambda: Magnetometer(0, 0, 0),
            "rc": lambda: _rc(autopilot.virtual if self._mirrors and autopilot.virtual_on else autopilot.rc),
            "gimbal": lambda: payload.reported(autopilot.time, pose.yaw),
            "status": lambda: FlightStatus(autopilot.status.value),
            "battery": lambda: round(autopilot.battery),
            "control": lambda: self._control(autopilot),
        }
        return Broadcast(**{part: whole[part]() for part in parts})

    def _position(self, pose: Pose) -> Position:
        latitude = HOME[0] + pose.north / EARTH
        longitude = HOME[1] + pose.east / (EARTH * math.cos(HOME[0]))
        return Position(latitude, longitude, ALTITUDE + pose.height, pose.height, self.health)

    def _control(self, autopilot: Autopilot) -> ControlSource:
        onboard = autopilot.pilot is Pilot.ONBOARD
        device = ControlDevice.ONBOARD_DEVICE if onboard else ControlDevice.REMOTE_CONTROLLER
        return ControlSource(self.mode, device, virtual_rc=autopilot.virtual_on)


def quaternion(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Of a drone turned by yaw, then pitch, then roll (rad), from north, east, down."""
    sr, sp, sy = (math.sin(angle / 2) for angle in (roll, pitch, yaw))
    cr, cp, cy = (math.cos(angle / 2) for angle in (roll, pitch, yaw))
    return Quaternion(
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def _rc(controls: Controls) -> Rc:
    roll, pitch, yaw, throttle = (
        round(10000 * value) for value in (controls.roll, controls.pitch, controls.yaw, controls.throttle)
    )
    return Rc(roll, pitch, yaw, throttle, MODES[controls.switch], RcGear.UP if controls.gear_up else RcGear.DOWN)
