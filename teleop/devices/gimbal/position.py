"""Makes a DJI gimbal follow the planner by position commands, and asks it where it is.

The gimbal goes to each position at constant speed over `time_for_action` and drops it for the next one, so a command
aims ahead, at where the axis will be that much later at its present velocity; on course, the gimbal then moves at just
that velocity (docs/explanation/planning.md, E). The target never lies beyond a soft limit, because the gimbal ends up
there when the next command does not come.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from functools import cache
from importlib.metadata import version

from teleop.config.wiring import Wiring, half_turn
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.connection import Answer, Connection
from teleop.devices.gimbal.aim_guard import AimGuard
from teleop.devices.gimbal.position_watch import PositionWatch
from teleop.devices.rate_divider import RateDivider
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.dji.message import Message, Result

TIME_FOR_ACTION = 0.1  # s, the shortest there is
POLL_RATE = 25  # Hz, questions for the angles: pushes may come once a second only (docs/protocol-facts.md)
GREETING_RATE = 1  # Hz, of the push of our own version: R SDK V2.5, section 2.3.4.10, figure 17
UNANSWERED = 0.3  # s without an answer after which a push is believed instead
REPEAT = 1.0  # s after which the position of a resting axis is sent again
YIELD, YIELD_FRESH = 5.0, 0.2  # deg from commanded at the end, by a reading no older (s): it is left where it is
REFUSALS = 5  # refused commands in a row before it is a fault: one may be damage that a checksum missed


class Angles:
    """Asks the gimbal where it is, and sends once a second who asks, as the document requires.

    Readings carry the time of the question: a gimbal samples within 5 ms of it. One that leaves questions unanswered is
    asked to push, and read from its pushes while it does not answer; they come seldom, and with no time of their own.

    `legacy_order` is how replies of old firmware order the angles: two sources say yaw, roll, pitch, one says yaw,
    pitch, roll; with all-yaw-pitch-roll every reply does. `bare` is whether the last reply was one of old firmware.

    Angles come in -180..180; a reading continues the one before it, so that an axis may turn on and on.
    """

    def __init__(self, connection: Connection, wiring: Wiring, legacy_order: str = "yaw-roll-pitch") -> None:
        self._connection, self._wiring = connection, wiring
        self.bare = False
        self._legacy_swapped = legacy_order == "yaw-pitch-roll"
        self._all_swapped = legacy_order == "all-yaw-pitch-roll"
        self._pace, self._greeting = RateDivider(POLL_RATE), RateDivider(GREETING_RATE)
        self._readings: dict[Axis, Reading] = {}
        self._push_request = RateDivider(GREETING_RATE)
        self._answered_at, self._unanswered = -math.inf, False
        connection.on_answer(gimbal.Angles, self._answered)
        connection.on_push(gimbal.Push, self._pushed)
        connection.on_push(gimbal.ShortPush, self._pushed)

    def report(self, now: float) -> Mapping[Axis, Reading]:
        self._connection.poll(now)
        if self._pace.due(now):
            self._connection.request(gimbal.Angles(AngleKind.ATTITUDE), now)
        if self._unanswered and self._push_request.due(now):
            self._connection.request(gimbal.PushSettings(gimbal.Switch.ON), now)
        if self._greeting.due(now):
            self._connection.stream(gimbal.VersionPush(version=own_version()))
        return self._readings

    def _answered(self, answer: Answer) -> None:
        reply = answer.reply
        self._unanswered = reply is None
        if not isinstance(reply, gimbal.AnglesReply | gimbal.LegacyAnglesReply) or reply.return_code:
            return
        if isinstance(reply, gimbal.LegacyAnglesReply) or reply.kind == AngleKind.ATTITUDE:
            self._answered_at = answer.sent
            second, third = reply.roll, reply.pitch
            self.bare = answer.bare
            swapped = self._all_swapped or (answer.bare and self._legacy_swapped)
            roll, pitch = (third, second) if swapped else (second, third)
            self._read(reply.yaw, roll, pitch, answer.sent)

    def _pushed(self, push: Message, now: float) -> None:
        if not isinstance(push, gimbal.Push | gimbal.ShortPush) or not push.angles_valid:
            return
        if now - self._answered_at > UNANSWERED:
            self._read(push.yaw, push.roll, push.pitch, now)

    def _read(self, yaw: float, roll: float, pitch: float, time: float) -> None:
        for axis, angle in self._wiring.from_gimbal(yaw, roll, pitch).items():
            if before := self._readings.get(axis):
                angle += 360 * round((before.position - angle) / 360)
            self._readings[axis] = Reading(angle, time)


class Refusals:
    """Raises DeviceError when the gimbal goes on refusing what it is sent."""

    def __init__(self, connection: Connection, command: type[Message]) -> None:
        self._in_a_row, self._code = 0, 0
        connection.on_answer(command, self._answered)

    def check(self) -> None:
        if self._in_a_row >= REFUSALS:
            self._in_a_row = 0
            raise DeviceError(f"the gimbal refuses to move (return code {self._code:#04x})")

    def _answered(self, answer: Answer) -> None:
        if isinstance(answer.reply, Result):
            self._code = answer.reply.return_code
            self._in_a_row = self._in_a_row + 1 if self._code else 0


class PositionSink:
    """Streams position commands; axes that are not in use are marked to be ignored.

    `rate` is in Hz, `delay` in s: how much later than commanded the gimbal moves. Axes that are `misreported` are never
    sent to where they are reported to be.
    """

    def __init__(
        self,
        connection: Connection,
        rate: int,
        delay: float,
        wiring: Wiring,
        limits: Mapping[Axis, Limits],
        misreported: Container[Axis] = (),
    ) -> None:
        self._misreported = misreported
        self._connection, self._delay, self._wiring, self._limits = connection, delay, wiring, limits
        self._pace = RateDivider(rate)
        self.guard, self.watch = AimGuard(limits), PositionWatch(limits, delay)
        self._refusals = Refusals(connection, gimbal.Position)
        self._sent: Mapping[Axis, float] = {}
        self._sent_at = -math.inf
        self._last: Tick | None = None
        self._unreached = False
        self._waited = False

    def write(self, tick: Tick) -> None:
        """Raises DeviceError when the gimbal refuses, and LinkError as the link does.

        After a LinkError nothing more is sent: the gimbal has long stopped at what reached it last, and would leap from
        there to wherever the plan has got to since. The run is ending anyway.
        """
        self._last = tick
        self.watch.note(tick)
        self._refusals.check()
        if self._unreached or not self._pace.due(tick.time, tick.motion):
            return
        aims = {
            axis: self.guard.aim(axis, self._aim(axis, state), tick)
            for axis, state in tick.motion.items()
            if axis in self._limits
        }
        if aims != self._sent or tick.time - self._sent_at >= REPEAT:
            self._unreached = True
            self._connection.request(position_command(aims, self._wiring, TIME_FOR_ACTION), tick.time)
            self._unreached = False
            self._sent, self._sent_at = aims, tick.time

    def release(self, now: float) -> float | None:
        """Nothing was taken over; the last command is left the time to be carried out.

        An axis that is far from it is sent to where it is: it must not set out once whatever holds it lets go.
        """
        if self._waited or self._unreached:
            return None
        if elsewhere := self._elsewhere(now):
            self._connection.request(position_command(elsewhere, self._wiring, TIME_FOR_ACTION), now)
        self._waited = True
        return now + TIME_FOR_ACTION

    def _elsewhere(self, now: float) -> Mapping[Axis, float]:
        if self._last is None:
            return {}
        aims, reported = self._last.motion, self._last.reported
        return {
            axis: reported[axis].position
            for axis in self._limits
            if axis not in self._misreported
            if axis in aims and axis in reported and now - reported[axis].time < YIELD_FRESH
            if abs(reported[axis].position - aims[axis].position) > YIELD
        }

    def _aim(self, axis: Axis, state: State) -> float:
        soon = (
            self._delay + self._pace.period / 2
        )  # a command is in force for a period: its speed is that of the middle
        velocity = state.velocity + soon * state.acceleration
        position = state.position + self._delay * (state.velocity + self._delay / 2 * state.acceleration)
        limits = self._limits[axis]
        beyond = min(limits.minimum, state.position), max(limits.maximum, state.position)
        return min(max(position + TIME_FOR_ACTION * velocity, beyond[0]), beyond[1])


def position_command(angles: Mapping[Axis, float], wiring: Wiring, seconds: float) -> gimbal.Position:
    """Go to these angles (deg, the operator's signs) over `seconds`; an axis that is not among them is ignored."""
    yaw, roll, pitch = wiring.to_gimbal({axis: half_turn(angle) for axis, angle in angles.items()})
    no_yaw, no_roll, no_pitch = wiring.undriven(angles)
    return gimbal.Position(
        yaw,
        roll,
        pitch,
        absolute=True,
        yaw_ignored=no_yaw,
        roll_ignored=no_roll,
        pitch_ignored=no_pitch,
        time_for_action=seconds,
    )


@cache
def own_version() -> str:
    """This program's version as AA.BB.CC.DD."""
    numbers = [int(part) for part in version("rs-teleop").split(".")[:4] if part.isdecimal()]
    return ".".join(f"{number:02}" for number in (numbers + [0] * 4)[:4])
