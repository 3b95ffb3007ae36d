"""The focus motor on the gimbal's bus: 0 (near) .. 1 (far) as the motor's 0..4095 between its calibrated ends.

Set commands are not answered, so the position is asked for; an uncalibrated motor ignores every command, so that is a
fault before anything moves, not a surprise in the rushes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from teleop.core.axes import Axis, Reading
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.connection import Answer, Connection
from teleop.devices.rate_divider import RateDivider
from teleop.dji.gimbal import focus

FULL = 4095  # the motor's steps from near to far: R SDK V2.5, section 2.3.4.19
LOWEST = 1  # 0 is ignored by some motors: docs/protocol-facts.md
POLL_RATE = 10  # Hz, questions for the position
REPEAT = 0.5  # s after which an unchanged position is sent again: a set command is not answered and may be lost


class FocusReporter:
    """Asks the motor where it is."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._pace = RateDivider(POLL_RATE)
        self._readings: dict[Axis, Reading] = {}
        self._calibrated = True
        connection.on_answer(focus.Get, self._answered)

    def report(self, now: float) -> Mapping[Axis, Reading]:
        """Raises DeviceError when the motor says that it is not calibrated."""
        self._connection.poll(now)
        if not self._calibrated:
            raise DeviceError("the focus motor is not calibrated, and ignores commands until it is")
        if self._pace.due(now):
            self._connection.request(focus.Get(), now)
        return self._readings

    def _answered(self, answer: Answer) -> None:
        if isinstance(answer.reply, focus.GetReply) and not answer.reply.return_code:
            self._calibrated = answer.reply.calibration != focus.EndpointState.UNCALIBRATED
            self._readings[Axis.FOCUS] = Reading(answer.reply.position / FULL, answer.sent)


class FocusSink:
    """Sends the position when it has changed, at most `rate` times a second."""

    def __init__(self, connection: Connection, rate: int) -> None:
        self._connection = connection
        self._pace = RateDivider(rate)
        self._sent, self._sent_at = -1, -math.inf

    def write(self, tick: Tick) -> None:
        if Axis.FOCUS not in tick.motion or not self._pace.due(tick.time):
            return
        step = max(LOWEST, min(FULL, round(tick.motion[Axis.FOCUS].position * FULL)))
        if step != self._sent or tick.time - self._sent_at >= REPEAT:
            self._connection.stream(focus.Set(step))
            self._sent, self._sent_at = step, tick.time

    def release(self, now: float) -> float | None:  # noqa: ARG002 - a motor stays where it was sent
        return None
