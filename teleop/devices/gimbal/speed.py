"""Makes a DJI gimbal follow the planner by speed commands: six times smoother than positions, for slow moves.

The gimbal forgets a speed after 0.5 s. Speed control is taken over with the first command and given back with
`release`: zero speed first, and then a short position command that levels what drifted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.devices.connection import Answer, Connection
from teleop.devices.gimbal.pi_correction import Gains
from teleop.devices.gimbal.position import Refusals, position_command
from teleop.devices.gimbal.speed_control import SpeedControl
from teleop.devices.rate_divider import RateDivider
from teleop.dji.gimbal import messages as gimbal

ZEROS, BETWEEN_ZEROS = 3, 0.05  # how to stop: zero speed so often, so many s apart (docs/protocol-facts.md)
GIVE_BACKS = 3  # times at most, until the gimbal confirms; more would not help one that does not answer
SETTLE = 0.5  # s for the last position command,
SETTLE_WITHIN = 1.0  # deg of error at the most,
SETTLE_FRESH = 1.0  # s since that was measured


class SpeedSink:
    """Streams speed commands for `limits`' axes; `delay` is how much later than commanded a speed is reached, in s.

    `on_sent` is called with the time and the speeds (deg/s) of each command, before it is sent.
    """

    def __init__(
        self,
        connection: Connection,
        rate: int,
        delay: float | None,
        wiring: Wiring,
        limits: Mapping[Axis, Limits],
        gains: Gains = Gains(),  # noqa: B008 - immutable
        on_sent: Callable[[float, Mapping[Axis, float]], object] = lambda _now, _speeds: None,
        priors: Mapping[Axis, Response] = MappingProxyType({}),
    ) -> None:
        self._on_sent = on_sent
        self._connection, self._wiring = connection, wiring
        self._pace = RateDivider(rate)
        self.control = SpeedControl(limits, self._pace.period, delay, gains, priors)
        self._refusals = Refusals(connection, gimbal.Speed)
        self._last: Tick | None = None
        self._taken_over = False
        self._zeros = self._given_back = 0  # how often each was sent
        self._waiting = -1  # the sequence number of a giving back that has not been answered
        connection.on_answer(gimbal.Speed, self._answered)

    def write(self, tick: Tick) -> None:
        self._refusals.check()
        self._last = tick
        self.control.note(tick)
        if self._pace.due(tick.time, tick.motion):
            self._taken_over = True  # before it is sent: what may have left must be given back
            self._send(self.control.speeds(tick), tick.time)

    def release(self, now: float) -> float | None:
        """Zero speed three times, control given back, and a short position command that levels what drifted.

        Control is given back again until the gimbal has answered: a lost frame must not leave it taken over.
        """
        if not self._taken_over:
            return None
        if self._zeros < ZEROS:
            self._send({}, now)
            self._zeros += 1
            return now + BETWEEN_ZEROS
        if self._given_back == 0 or (self._waiting >= 0 and self._given_back < GIVE_BACKS):
            give_back = gimbal.Speed(0.0, 0.0, 0.0, take_over=False, ignore_focal_length=True)
            self._waiting = self._connection.request(give_back, now)
            self._given_back += 1
            return now + BETWEEN_ZEROS
        self._taken_over = False
        targets = self._settled(now)
        if not targets:
            return None
        self._connection.request(position_command(targets, self._wiring, SETTLE), now)
        return now + SETTLE

    def _answered(self, answer: Answer) -> None:
        if answer.sequence == self._waiting and answer.reply is not None:
            self._waiting = -1

    def _send(self, wanted: Mapping[Axis, float], now: float) -> None:
        speeds = {axis: round(speed, 1) for axis, speed in wanted.items()}  # as the message has them
        self._on_sent(now, speeds)
        self.control.sent(now, speeds)
        yaw, roll, pitch = self._wiring.speeds_to_gimbal(speeds)
        self._connection.request(gimbal.Speed(yaw, roll, pitch, take_over=True, ignore_focal_length=True), now)

    def _settled(self, now: float) -> Mapping[Axis, float]:
        """Where to settle: nowhere when the gimbal is not known to be close, it must not set out again unasked.

        An axis that was last commanded to move was left in the middle of that, and has no place to settle at.
        """
        if self._last is None or any(state.velocity or state.acceleration for state in self._last.motion.values()):
            return {}
        targets = {axis: state.position for axis, state in self._last.motion.items() if axis in self._wiring.axes}
        for axis, target in targets.items():
            reading = self._last.reported.get(axis)
            if reading is None or now - reading.time > SETTLE_FRESH or abs(reading.position - target) > SETTLE_WITHIN:
                return {}
        return targets
