"""A drone held by movement commands, for which it has to give control: tilts, velocities or offsets, 50 times a second.

Control is asked for once, and again only when the drone says that it is at it; what it refuses is said.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from teleop.dji import drone, movement
from teleop.dji.drone_words import ControlCode, ControlDevice, ControlOrder, TaskKind
from teleop.motion import STICKS
from teleop.sinks.connection import Answer, Connection
from teleop.sinks.grips import ARMING, Deflections, attitude, not_in_standby, word_of
from teleop.sinks.preflight import Site, mode_refusals, mode_warnings
from teleop.sinks.stick_numbers import numbers
from teleop.sinks.telemetry import Telemetry

OBTAIN_AGAIN = 0.5  # s between two requests for control: osdk-facts.md, Link and frame
MOVE_ALONE = "what the drone does then is not known: its pilot has to take it, by leaving F"


class MovementGrip:
    """Movement commands with control obtained: the sticks as shares of `full`, x, y, z and yaw of a combination.

    A yaw angle is counted from the heading that the drone had when it was taken, and a height from its height then, so
    that centred sticks are where it is. Neutral is where it is now. While it does a task by itself nothing is streamed,
    which could contradict it, until a stick is moved.
    """

    what, period, alone = "control", 0.02, MOVE_ALONE

    def __init__(
        self,
        connection: Connection,
        combination: movement.Combination,
        frame: movement.Frame,
        full: Mapping[str, float],
        site: Site,
    ) -> None:
        self._connection, self._combination, self._frame = connection, combination, frame
        self._full, self._site = full, site
        self.say: Callable[[str], object] = lambda _text: None
        self._heading = self._height = 0.0  # when it was taken: deg, m
        self._obtained: bool | None = None
        self._ask_at = math.inf  # s: when control is to be asked for
        self._tasks, self._by_itself = 0, False
        connection.on_answer(drone.Control, self._answered)
        connection.on_answer(drone.Task, self._told)
        connection.on_answer(drone.Arm, self._told)

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:
        position = seen.get("position", now)
        yield from mode_refusals(self._combination, self._site, None if position is None else position.health)
        if self._combination.yaw == movement.Yaw.ANGLE and seen.get("quaternion", now) is None:
            yield "the drone does not say where it looks, and yaw angles start from there"
        if self._combination.vertical == movement.Vertical.POSITION and position is None:
            yield "the drone does not say how high it is, and heights start from there"

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]:
        position = seen.get("position", now)
        yield from mode_warnings(self._combination, self._site, None if position is None else position.height)

    def take(self, seen: Telemetry, now: float) -> None:
        self._heading, self._height = self._here(seen, now)
        self._obtained, self._ask_at, self._by_itself = None, now, False
        self._ask(now)

    def drive(self, sticks: Deflections, seen: Telemetry, now: float) -> None:  # noqa: ARG002 - the sticks alone say it
        self._ask(now)
        self._by_itself = self._by_itself and not any(sticks.values())
        if self._obtained and not self._by_itself:
            self._connection.stream(self._move(sticks, self._heading, self._height))

    def neutral(self, seen: Telemetry, now: float) -> None:
        if self._obtained and not self._by_itself:
            self._connection.stream(self._move(dict.fromkeys(STICKS, 0.0), *self._here(seen, now)))

    def withdraw(self) -> None:
        self._connection.withdraw(drone.Control, drone.Task, drone.Arm)

    def give_back(self, now: float) -> None:
        self._connection.request(drone.Control(ControlOrder.RELEASE), now)

    def held(self, seen: Telemetry, now: float) -> bool | None:
        control = seen.get("control", now)
        if self._obtained and control is not None:
            return control.device == ControlDevice.ONBOARD_DEVICE
        return self._obtained

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        if word in ARMING:
            if refusal := not_in_standby(seen, now):
                return f"{word} refused: {refusal}"
            self._connection.request(drone.Arm(ARMING[word]), now)
            return f"{word}: asked for"
        tasks = {"take-off": TaskKind.TAKE_OFF, "land": TaskKind.LAND, "home": TaskKind.RETURN_HOME}
        self._connection.request(drone.Task(tasks[word], number=self._tasks), now)
        self._tasks, self._by_itself = self._tasks + 1 & 0xFF, True
        return f"{word}: asked for; no sticks are sent until one is moved"

    def _ask(self, now: float) -> None:
        """Ask for control: once, and again when the drone says that it is at it."""
        if now >= self._ask_at:
            self._ask_at = math.inf
            self._connection.request(drone.Control(ControlOrder.OBTAIN), now)

    def _here(self, seen: Telemetry, now: float) -> tuple[float, float]:
        """Heading (deg) and height (m) now, as far as they are known, else as they were when it was taken."""
        quaternion, position = seen.get("quaternion", now), seen.get("position", now)
        heading = self._heading if quaternion is None else attitude(quaternion)[2]
        return heading, self._height if position is None else position.height

    def _move(self, sticks: Deflections, heading: float, height: float) -> movement.Move:
        x, y, z, yaw = numbers(self._combination, self._full, sticks, heading, height)
        return movement.Move(
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

    def _answered(self, answer: Answer) -> None:
        code = getattr(answer.reply, "code", None)
        if code == ControlCode.OBTAINING:
            self._ask_at = answer.sent + OBTAIN_AGAIN
            return
        self._obtained = code == ControlCode.OBTAINED
        if code is None:
            self.say("the drone did not answer when asked about control")
        elif code not in (ControlCode.OBTAINED, ControlCode.RELEASED, ControlCode.RELEASING):
            self.say(f"the drone refuses control: {word_of(code)}")

    def _told(self, answer: Answer) -> None:
        name = "motors" if isinstance(answer.reply, drone.ArmAck | drone.ShortArmAck) else "task"
        code = getattr(answer.reply, "code", None)
        if answer.reply is None:
            self.say(f"{name}: no answer")
            self._by_itself = False
        elif code:
            self._by_itself = False
            self.say(f"{name}: refused, {word_of(code)}")
