"""Makes a DJI gimbal follow the planner as if its joystick were held: pushes of 0x0A.

Some firmware ignores speed commands and obeys these (docs/protocol-facts.md). How fast full deflection
is follows a setting on the gimbal, which the profile repeats; what that gets wrong, the correction has to make up.
A push has no reply and nothing is taken over: `release` lets the stick go.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.devices.connection import Connection
from teleop.devices.gimbal.pi_correction import Gains
from teleop.devices.gimbal.speed import BETWEEN_ZEROS, ZEROS
from teleop.devices.gimbal.speed_control import SpeedControl
from teleop.devices.rate_divider import RateDivider
from teleop.dji.gimbal.joystick import deflection
from teleop.dji.gimbal.messages import Joystick
from teleop.identification.candidates import Start

SETTING = Start(gain_doubt=0.15, gains=(0.4, 2.5))  # what full deflection gives may not be what the profile says


class StickSink:
    """Streams joystick pushes, `rate` a second; `full` is what full deflection gives each axis, in deg/s.

    `delay` is how much later than commanded a speed is reached, in s. `on_sent` is called with the time and the speeds
    (deg/s) of each push, before it is sent.
    """

    def __init__(
        self,
        connection: Connection,
        rate: int,
        delay: float | None,
        wiring: Wiring,
        limits: Mapping[Axis, Limits],
        full: Mapping[Axis, float],
        gains: Gains = Gains(),  # noqa: B008 - immutable
        on_sent: Callable[[float, Mapping[Axis, float]], object] = lambda _now, _speeds: None,
        priors: Mapping[Axis, Response] = MappingProxyType({}),
    ) -> None:
        self._on_sent = on_sent
        self._connection, self._wiring, self._full = connection, wiring, full
        self._pace = RateDivider(rate)
        self.control = SpeedControl(limits, self._pace.period, delay, gains, priors, SETTING)
        self._zeros = ZEROS  # nothing to let go yet

    def write(self, tick: Tick) -> None:
        self.control.note(tick)
        if self._pace.due(tick.time, tick.motion):
            self._zeros = 0
            self._push(self.control.speeds(tick), tick.time)

    def release(self, now: float) -> float | None:
        """The stick in its middle, three times: a push is not answered, and one may be lost."""
        if self._zeros >= ZEROS:
            return None
        self._push({}, now)
        self._zeros += 1
        return now + BETWEEN_ZEROS

    def _push(self, speeds: Mapping[Axis, float], now: float) -> None:
        self._on_sent(now, speeds)
        self.control.sent(now, speeds)
        deflections = {axis: deflection(speed, 0.0, self._full[axis]) for axis, speed in speeds.items()}
        yaw, roll, pitch = (round(value) for value in self._wiring.speeds_to_gimbal(deflections))
        self._connection.stream(Joystick(pitch=pitch, roll=roll, yaw=yaw))
