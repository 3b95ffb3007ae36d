"""The three axes of a simulated gimbal: what its commands make of the motors, and what they report.

On the wire an axis may have the opposite sign, and its speed another one than its angle, as firmware differs; the
motors turn in the signs of `core.axes`, and limits, which are magnitudes on the wire, are the motors' own. Angles are
rounded to 0.1 degree by the messages, never in here. The document leaves open what happens to a target beyond a stop
(it ends at the stop), to an axis that turns for ever (it goes the short way round), and to a position command under
speed control (it wins).
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Any, NamedTuple

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import ReturnCode
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware
from teleop.sim.gimbal.handlers import Answer, Handlers, timeless
from teleop.sim.gimbal.motors import Motor

SPEED_HOLDS = 0.5  # s after which a speed command no longer counts: V2.5, section 2.3.4.2
STICK_FULL = 15_000  # full deflection on the wire: section 2.3.4.11
SETTLES = 0.3  # s in which a roll that is left off level gets there
WIRE_STEP = 0.1  # deg, of every angle on the wire
CENTRING_LAG = 0.3  # s, so that recentring is all but done in 1.5 s


class Angles(NamedTuple):
    """Degrees, or degrees per second, in the order of most messages."""

    yaw: float
    roll: float
    pitch: float


MECHANICAL_UP, MECHANICAL_DOWN = Angles(180.0, 30.0, 146.0), Angles(180.0, 30.0, 56.0)  # section 2.3.4.1
NAMEABLE_UP, NAMEABLE_DOWN = Angles(179.0, 30.0, 145.0), Angles(179.0, 30.0, 55.0)  # in a message: section 2.3.4.4


class GimbalAxes:
    """Motors for yaw, roll and pitch, and the messages that move and ask them.

    `mount` is the yaw (deg) to which the gimbal's mount is turned: its middle, its stops and where it boots are there.
    `dynamics` are those of yaw, roll and pitch; None for the `lag` alone.
    """

    def __init__(
        self,
        boot: Angles,
        signs: Angles,
        lag: float,
        joystick_speed: Angles,
        continuous: bool,
        firmware: Firmware = DOCUMENTED,
        dynamics: Sequence[Dynamics] | None = None,
        mount: float = 0.0,
    ) -> None:
        self.controlled = False  # whether a speed command has taken over, and none has given back
        self._mount = Angles(mount, 0.0, 0.0)
        self._boot = boot._replace(yaw=boot.yaw + mount)
        self._chance = random.Random(1)  # noise repeats
        self._signs = signs
        self._speed_signs = Angles(*firmware.speed_signs) if firmware.speed_signs else signs
        self._report_signs = Angles(*firmware.report_signs) if firmware.report_signs else signs
        self._firmware = firmware
        self._joystick_speed = joystick_speed
        self._motors = [Motor(angle, lag) for angle in self._boot]
        self.change(dynamics or [Dynamics(lag=lag)] * len(self._motors))
        self._nameable_up = NAMEABLE_UP._replace(pitch=float(firmware.pitch_max))
        self._restrict(MECHANICAL_UP._replace(pitch=firmware.pitch_max + 1.0), MECHANICAL_DOWN)
        if continuous:
            self._motors[0].minimum, self._motors[0].maximum = -math.inf, math.inf
        self.handlers: Handlers = {
            gimbal.Position: self._position,
            gimbal.Speed: self._speed,
            gimbal.Joystick: self._joystick,
            gimbal.Angles: self._report,
            gimbal.SetLimits: self._set_limits,
            gimbal.Limits: timeless(self._report_limits),
        }

    def change(self, dynamics: Sequence[Dynamics]) -> None:
        """Move and report so from now on, as with another payload; commands before keep what they had."""
        for motor, each in zip(self._motors, dynamics, strict=True):
            motor.dynamics = each

    def angles(self, time: float) -> Angles:
        """Exact, in the signs of `core.axes`; an axis without stops counts its turns."""
        return Angles(*(motor.at(time)[0] for motor in self._motors))

    def rates(self, time: float) -> Angles:
        return Angles(*(motor.at(time)[1] for motor in self._motors))

    def reported(self, time: float) -> Angles:
        """As on the wire: late, noisy and in steps, in the wire's signs, and within half a turn."""
        signed = zip(self._report_signs, self._motors, strict=True)
        return Angles(*(_half_turn(sign * self._measured(motor, time)) for sign, motor in signed))

    def limits(self) -> dict[str, Any]:
        """The fields of LimitsReply and Push, no more than these can name."""
        most, least = self._nameable_up, NAMEABLE_DOWN
        turned = list(zip(self._motors, self._mount, strict=True))
        up = [min(motor.maximum - middle, limit) for (motor, middle), limit in zip(turned, most, strict=True)]
        down = [min(middle - motor.minimum, limit) for (motor, middle), limit in zip(turned, least, strict=True)]
        names = ("yaw", "roll", "pitch")
        named = {f"{name}_max": round(value) for name, value in zip(names, up, strict=True)}
        return named | {f"{name}_min": round(value) for name, value in zip(names, down, strict=True)}

    def turn(self, now: float, target: Angles) -> None:
        """Ease to these angles of the mount, as recentring does."""
        for motor, angle, middle in zip(self._motors, target, self._mount, strict=True):
            motor.ease(now, self._nearest(motor, angle + middle, middle, now), CENTRING_LAG)

    def halt(self, now: float) -> None:
        """The motors lose their power; nothing sags."""
        for motor in self._motors:
            motor.halt(now)

    def hold(self, now: float, held: Angles) -> None:
        """A hand holds the axes that are true, and lets go of the others; a touch stops an axis."""
        for motor, hand in zip(self._motors, held, strict=True):
            if motor.held != bool(hand):
                motor.hold(now, bool(hand))

    def boot(self) -> None:
        """Go back to the start position, with no command in force."""
        self.controlled = False
        for motor, angle in zip(self._motors, self._boot, strict=True):
            motor.place(angle)

    def _position(self, message: gimbal.Position, now: float) -> Answer:
        ignored = message.yaw_ignored, message.roll_ignored, message.pitch_ignored
        if self.controlled and self._firmware.position_under_speed == "ignore":
            return ReturnCode.OK
        wanted = message.yaw, message.roll, message.pitch
        targets: list[tuple[Motor, float]] = []
        for motor, sign, angle, middle, ignore in zip(
            self._motors, self._signs, wanted, self._mount, ignored, strict=True
        ):
            if not ignore:
                absolute = self._nearest(motor, sign * angle, middle, now)
                targets.append((motor, absolute if message.absolute else motor.at(now)[0] + sign * angle))
        if self._firmware.beyond_stop == "refuse" and any(motor.clamp(target) != target for motor, target in targets):
            return ReturnCode.FAILED
        for motor, target in targets:
            motor.travel(now, target, message.time_for_action)
        return ReturnCode.OK

    def _speed(self, message: gimbal.Speed, now: float) -> Answer:
        if self._firmware.ignores_speed:
            return ReturnCode.OK
        released = self.controlled and not message.take_over
        self.controlled = message.take_over
        if message.take_over:
            self._cruise(Angles(message.yaw, message.roll, message.pitch), now)
        else:
            for motor in self._motors:
                motor.coast(now)
        if released and self._firmware.roll_error:
            roll = self._motors[1]
            roll.travel(now, roll.at(now)[0] + self._firmware.roll_error, SETTLES)
        return ReturnCode.OK

    def _joystick(self, message: gimbal.Joystick, now: float) -> Answer:
        deflections = message.yaw, message.roll, message.pitch
        shares = (min(max(value / STICK_FULL, -1.0), 1.0) for value in deflections)
        self._cruise(Angles(*(share * full for share, full in zip(shares, self._joystick_speed, strict=True))), now)
        return ReturnCode.OK

    def _cruise(self, speeds: Angles, now: float) -> None:
        for motor, sign, speed in zip(self._motors, self._speed_signs, speeds, strict=True):
            motor.cruise(now, sign * speed, now + SPEED_HOLDS)

    def _report(self, message: gimbal.Angles, now: float) -> Answer:
        if message.kind == gimbal.AngleKind.NONE:
            return gimbal.AnglesReply(ReturnCode.OK, gimbal.AngleKind.NONE, 0.0, 0.0, 0.0)
        angles = self.reported(now)
        return gimbal.AnglesReply(ReturnCode.OK, message.kind, angles.yaw, angles.roll, angles.pitch)

    def _set_limits(self, message: gimbal.SetLimits, now: float) -> Answer:
        if message.operation == gimbal.Operation.EXECUTE:
            up = Angles(message.yaw_max, message.roll_max, message.pitch_max)
            self._restrict(up, Angles(message.yaw_min, message.roll_min, message.pitch_min))
            for motor in self._motors:
                motor.coast(now)  # what was under way may lead beyond the new stops
        return ReturnCode.OK

    def _report_limits(self, message: gimbal.Limits) -> Answer:
        if message.operation == gimbal.Operation.NOTHING:
            return ReturnCode.OK
        return gimbal.LimitsReply(ReturnCode.OK, **self.limits())

    def _restrict(self, up: Angles, down: Angles) -> None:
        for motor, most, least, middle in zip(self._motors, up, down, self._mount, strict=True):
            motor.minimum, motor.maximum = middle - least, middle + most

    def _measured(self, motor: Motor, time: float) -> float:
        """What the axis's own sensor says of it at `time`."""
        dynamics = motor.dynamics
        angle = motor.at(time - dynamics.report_age)[0]
        if dynamics.noise:
            angle += self._chance.gauss(0.0, dynamics.noise)
        if dynamics.resolution > WIRE_STEP:
            angle = round(angle / dynamics.resolution) * dynamics.resolution
        return angle

    def _nearest(self, motor: Motor, angle: float, middle: float, now: float) -> float:
        """The position that has `angle`: between the stops, or of an axis without any the one half a turn away at most.

        `middle` is where the mount has the middle of the axis.
        """
        if math.isfinite(motor.maximum):
            return middle + _half_turn(angle - middle)
        position = motor.at(now)[0]
        return position + _half_turn(angle - position)


def _half_turn(angle: float) -> float:
    """The same direction within -180..180 degrees; 180 stays 180."""
    return angle if -180.0 <= angle <= 180.0 else (angle + 180.0) % 360.0 - 180.0
