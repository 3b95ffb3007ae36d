"""Which way a gimbal counts: half a degree by a position command and back, half a degree by a speed and back.

Positions are sent as increments, so that nothing leaps whatever the signs are. Everything is in the gimbal's own signs:
what a profile makes of them is for the one who asks. The probe is a source too, because the planner only rests
meanwhile. It ends where it began, within the gimbal's grid of 0.1 deg.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits, Motion
from teleop.core.errors import DeviceError
from teleop.core.events import SourceEvent, Tick, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand
from teleop.devices.connection import Connection
from teleop.devices.gimbal.speed import BETWEEN_ZEROS, ZEROS
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.joystick import deflection
from teleop.dji.message import Message

REACH = 0.5  # deg
ROOM = 0.6  # deg to either soft limit
RUNAWAY = 1.5  # deg from the start: nothing that was sent leads there
SPEED = 1.0  # deg/s
SAME_PLACE = 0.2  # deg, half of what a move of REACH is with noise of 0.1 deg and backlash
LISTEN = 0.5  # s over which readings are averaged
TRAVEL = 0.5  # s for a move
AGAIN = 0.05  # s between two commands of the same speed


@dataclass(frozen=True)
class Signs:
    """Which way the reported angle goes (1 or -1) by a position, and by a speed, that is positive; 0: nowhere."""

    position: int
    speed: int


class SignProbe:
    """Measures the `axes` one after the other; `signs` has what was found, `done` says that all was.

    `wiring` and `limits` are the profile's. `full` is what a full stick gives in deg/s, for a gimbal that is moved by
    its joystick; None for speed commands.
    """

    def __init__(
        self,
        connection: Connection,
        axes: Sequence[Axis],
        wiring: Wiring,
        limits: Mapping[Axis, Limits],
        full: Callable[[Axis], float] | None,
    ) -> None:
        self.signs: dict[Axis, Signs] = {}
        self.done = False
        self._connection, self._wiring, self._limits, self._full = connection, wiring, limits, full
        self._now = self._wake = 0.0
        self._start: Motion = {}
        self._readings: dict[Axis, list[float]] = {axis: [] for axis in axes}
        self._last_read: dict[Axis, float] = {}
        self._taken = False
        self._zeros = ZEROS
        self._halted = False
        self._begins: dict[Axis, float] = {}  # where each axis was before the first move, as reported
        self._steps = self._script(axes)

    def start(self, now: float, motion: Motion) -> None:
        """Raises DeviceError when an axis has no room."""
        self._start, self._wake = motion, now
        for axis in self._readings:
            place, limits = self._wiring.report_sign(axis) * motion[axis].position, self._limits[axis]
            if min(limits.maximum - place, place - limits.minimum) < ROOM:
                raise DeviceError(f"{axis} has no room for a test move of {REACH:g} deg: move it further in")

    def read(self, _now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:  # the planner only rests
        return {}, ()

    def next_change(self, now: float) -> float:
        return math.inf if self.done else now

    resumable, pauses, quits = True, False, False  # a pause would spoil a measurement: the axis is measured anew

    @property
    def busy(self) -> bool:
        """Whether speed control is still being released after a halt."""
        return self._taken

    def pause(self, now: float) -> bool | None:  # noqa: ARG002 - see `pauses`
        return False

    def suspend(self, now: float) -> None:
        """Hold every axis where it is; a move that was sent has half a degree left at most."""
        if self._halted:
            return
        self._halted, self._now, self._zeros, self._wake = True, now, ZEROS, now
        if not self._taken:
            self._send(gimbal.Position(0.0, 0.0, 0.0, False, time_for_action=0.1))

    def linger(self, now: float) -> Sequence[TickEvent]:
        """Zero speed three times, then speed control is released."""
        if self._taken and now >= self._wake - 1e-6:
            again = self.release(now)
            self._wake = now if again is None else again
        return ()

    def resume(self, now: float, motion: Motion) -> None:  # noqa: ARG002 - it measures by what is reported
        """Measure the axis that was being measured anew, then the others."""
        self._halted, self._wake, self._zeros = False, now, ZEROS
        self._steps = self._script([axis for axis in self._readings if axis not in self.signs])

    def write(self, tick: Tick) -> None:
        """Raises DeviceError when an axis does not move, or runs away."""
        self._now = tick.time
        for axis, readings in self._readings.items():
            reading = tick.reported.get(axis)
            if reading and reading.time != self._last_read.get(axis):
                self._last_read[axis] = reading.time
                readings.append(reading.position)
                if abs(moved := reading.position - self._start[axis].position) > RUNAWAY:
                    self.done = True
                    raise DeviceError(f"{axis} moved {abs(moved):.1f} deg where {REACH:g} were sent")
        while not self.done and not self._halted and tick.time >= self._wake - 1e-6:
            wait = next(self._steps, None)
            self.done = wait is None
            self._wake = tick.time + (wait or 0.0)

    def release(self, now: float) -> float | None:
        """Zero speed three times, and speed control given back: also when it was stopped on the way."""
        if not self._taken:
            return None
        self._zeros -= 1
        self._now = now
        if self._zeros >= 0:
            self._move({})
            return now + BETWEEN_ZEROS
        self._let_go()
        return None

    def _script(self, axes: Sequence[Axis]) -> Iterator[float]:
        """One axis after the other; what is yielded is how many s to wait."""
        for axis in axes:
            begin = self._begins.setdefault(axis, (yield from self._place(axis)))
            position = yield from self._shift(axis, REACH)
            if not position:
                raise DeviceError(f"{axis} did not move by a position command: is it held by hand, locked or asleep?")
            yield from self._shift(axis, -REACH)
            there = yield from self._cruise(axis, SPEED)
            back = yield from self._cruise(axis, -SPEED)
            if there != back:
                raise DeviceError(f"{axis} drifted while it was measured: keep the gimbal still and try again")
            self.signs[axis] = Signs(position, there)
            left = begin - (yield from self._place(axis))
            if abs(left) >= 0.1:
                yield from self._shift(axis, position * left)

    def _place(self, axis: Axis) -> Iterator[float]:
        """Where the axis is, over some readings."""
        self._readings[axis].clear()
        yield LISTEN
        if len(self._readings[axis]) < 2:
            raise DeviceError(f"{axis}: too few readings to measure by")
        return fmean(self._readings[axis])

    def _shift(self, axis: Axis, way: float) -> Iterator[float]:
        """Move by so many deg with a position command; which way the reading went for a positive one."""
        before = yield from self._place(axis)
        self._send(self._position(axis, way))
        yield TRAVEL + 0.5
        return _sign((yield from self._place(axis)) - before, way)

    def _cruise(self, axis: Axis, speed: float) -> Iterator[float]:
        before = yield from self._place(axis)
        for _ in range(round(REACH / SPEED / AGAIN)):
            self._move({axis: speed})
            yield AGAIN
            if abs(self._readings[axis][-1] - before) >= REACH:
                break
        for _ in range(ZEROS):
            self._move({})
            yield BETWEEN_ZEROS
        self._let_go()
        yield 0.3
        return _sign((yield from self._place(axis)) - before, speed)

    def _position(self, axis: Axis, way: float) -> gimbal.Position:
        yaw, roll, pitch = (way if each == axis else 0.0 for each in self._wiring.axes)
        ignored = self._wiring.undriven({axis: way})
        return gimbal.Position(yaw, roll, pitch, False, *ignored, time_for_action=TRAVEL)

    def _move(self, speeds: Mapping[Axis, float]) -> None:
        self._taken = True
        yaw, roll, pitch = (0.0 if each is None else speeds.get(each, 0.0) for each in self._wiring.axes)
        if self._full is None:
            self._send(gimbal.Speed(yaw, roll, pitch, take_over=True, ignore_focal_length=True))
            return
        shares = {each: deflection(speed, 0.0, self._full(each)) for each, speed in speeds.items()}
        yaw, roll, pitch = (0 if each is None else shares.get(each, 0) for each in self._wiring.axes)
        self._send(gimbal.Joystick(pitch=pitch, roll=roll, yaw=yaw))

    def _let_go(self) -> None:
        if self._full is None:
            self._send(gimbal.Speed(0.0, 0.0, 0.0, take_over=False, ignore_focal_length=True))
        self._taken = False

    def _send(self, message: Message) -> None:
        self._connection.request(message, self._now)


def _sign(moved: float, way: float) -> int:
    return 0 if abs(moved) < SAME_PLACE else 1 if moved * way > 0 else -1
