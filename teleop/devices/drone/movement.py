"""A drone held by movement commands, for which it has to give control: tilts, velocities or offsets, 50 times a second.

Control is the affair of `authority`, what the drone does by itself that of `tasks`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from teleop.core.axes import STICKS
from teleop.devices.connection import Answer, Connection
from teleop.devices.drone.control_authority import ControlAuthority
from teleop.devices.drone.control_mode import ARMING, Deflections, attitude, not_in_standby, word_of
from teleop.devices.drone.preflight import Site, mode_refusals, mode_warnings
from teleop.devices.drone.stick_numbers import numbers
from teleop.devices.drone.tasks import WORDS, TaskWatch, take_off_refusal
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone import messages as drone
from teleop.dji.drone import movement
from teleop.dji.drone.enums import ArmCode, ArmOrder

MOVE_ALONE = "what the drone does then is not known: its pilot has to take it, by leaving F"
CENTERED: Deflections = dict.fromkeys(STICKS, 0.0)


class MovementControl:
    """Movement commands with control obtained: the sticks as shares of `full`, x, y, z and yaw of a combination.

    A yaw angle is counted from the heading that the drone had when it was taken, and a height from its height then, so
    that centered sticks are where it is; after a task both count from where that has left it. Neutral is where it is
    now. While a task runs nothing is streamed, which would break it off, until a stick is moved.
    """

    what, period, alone = "control", 0.02, MOVE_ALONE
    gap, taken, repeats = 0.0, -math.inf, True

    def __init__(
        self,
        connection: Connection,
        combination: movement.Combination,
        frame: movement.ReferenceFrame,
        full: Mapping[str, float],
        site: Site,
    ) -> None:
        self._connection, self._combination, self._frame = connection, combination, frame
        self._full, self._site = full, site
        self.notify: Callable[[str], object] = lambda _text: None
        self._authority = ControlAuthority(connection, lambda text: self.notify(text))
        self._task = TaskWatch(lambda text: self.notify(text))
        self._heading = self._height = 0.0  # from which places count: deg, m
        self._number = 0  # of the next task
        self._newest = -1  # the sequence number of the newest task's order
        self._arming: ArmOrder | None = None  # asked for
        self._armed = False  # by this program
        connection.on_answer(drone.Task, self._task_answered)
        connection.on_answer(drone.Arm, self._arm_answered)

    @property
    def patience(self) -> float:
        return self._authority.patience

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:
        position = seen.get("position", now)
        yield from mode_refusals(self._combination, self._site, None if position is None else position.health)
        if self._combination.yaw == movement.Yaw.ANGLE and seen.get("quaternion", now) is None:
            yield "the drone does not report where it looks, and yaw angles start from there"
        if self._combination.vertical == movement.Vertical.POSITION and position is None:
            yield "the drone does not report how high it is, and heights start from there"

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]:
        position = seen.get("position", now)
        yield from mode_warnings(self._combination, self._site, None if position is None else position.height)

    def take(self, seen: Telemetry, now: float) -> None:
        self._heading, self._height = self._here(seen, now)
        self._authority.obtain(now)

    def watch(self, seen: Telemetry, now: float) -> None:
        ran = self._task.runs
        self._task.watch(seen, now)
        if ran and not self._task.runs:
            self._heading, self._height = self._here(seen, now)

    def drive(self, sticks: Deflections, seen: Telemetry, now: float) -> None:
        self._authority.service(now)
        if self._task.moved(sticks):
            self._heading, self._height = self._here(seen, now)
        if self._authority.obtained(seen, now) and not self._task.runs:
            self._stream(CENTERED if self._task.locks_sticks else sticks, self._heading, self._height)

    def neutral(self, seen: Telemetry, now: float) -> None:
        if self._authority.obtained(seen, now) and not self._task.runs:
            self._stream(CENTERED, *self._here(seen, now))

    def withdraw(self) -> None:
        self._authority.cancel()
        self._connection.withdraw(drone.Task, drone.Arm)

    def give_back(self, now: float) -> None:
        if goes_on := self._task.goes_on():
            self.notify(goes_on)
        self._authority.release(now)

    def give_back_again(self, now: float) -> None:
        self._authority.service(now)

    def held(self, seen: Telemetry, now: float) -> bool | None:
        return self._authority.held(seen, now)

    def contradicted(self, seen: Telemetry, now: float) -> bool:
        return self._authority.still_held(seen, now)

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        if word in ARMING:
            if refusal := not_in_standby(seen, now):
                return f"{word} refused: {refusal}"
            self._arming = ARMING[word]
            self._connection.request(drone.Arm(ARMING[word]), now)
            return f"{word}: asked for"
        kind = WORDS[word]
        if kind is self._task.kind:
            return f"{word}: it is under way"
        if word == "take-off" and (refusal := take_off_refusal(seen, now, self._armed)):
            return f"{word} refused: {refusal}"
        self._newest = self._connection.request(drone.Task(kind, number=self._number), now)
        self._number = self._number + 1 & 0xFF
        self._task.begin(kind, now)
        return f"{word}: asked for; no sticks until it ends or one is moved"

    def _here(self, seen: Telemetry, now: float) -> tuple[float, float]:
        """Heading (deg) and height (m) now, as far as they are known, else as they were when it was taken."""
        quaternion, position = seen.get("quaternion", now), seen.get("position", now)
        heading = self._heading if quaternion is None else attitude(quaternion)[2]
        return heading, self._height if position is None else position.height

    def _stream(self, sticks: Deflections, heading: float, height: float) -> None:
        x, y, z, yaw = numbers(self._combination, self._full, sticks, heading, height)
        self._connection.stream(
            movement.Move(
                stable=self._combination.horizontal == movement.Horizontal.VELOCITY,
                frame=self._frame,
                yaw_control=self._combination.yaw,
                vertical=self._combination.vertical,
                horizontal=self._combination.horizontal,
                x=x,
                y=y,
                z=z,
                yaw=yaw,
            )
        )

    def _task_answered(self, answer: Answer) -> None:
        if answer.sequence == self._newest:
            self._armed = False  # what runs now was started by the task
            self._task.answered(None if answer.reply is None else getattr(answer.reply, "code", "unknown"))

    def _arm_answered(self, answer: Answer) -> None:
        code = None if answer.reply is None else getattr(answer.reply, "code", "unknown")
        if code in (ArmCode.OK, ArmCode.ALREADY):
            self._armed = self._arming == ArmOrder.ARM
        if code is None:
            self.notify("motors: no answer")
        elif code:
            self.notify(f"motors: refused, {word_of(code)}")
