"""The two ways to hold a drone: by the virtual RC, or by movement commands. What is sent, and nothing of when.

Both take the same four sticks, -1..1, with the same sense: roll right, pitch forward, throttle up, yaw right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from enum import IntEnum
from typing import Protocol

from teleop.dji import drone, movement
from teleop.dji.drone_words import (
    ArmOrder,
    ControlCode,
    ControlDevice,
    ControlOrder,
    FlightStatus,
    GearChannel,
    ModeChannel,
    TaskKind,
)
from teleop.dji.virtual_rc import CENTRE, DEFLECTION, NEUTRAL, Sticks, VirtualRc
from teleop.motion import STICKS, Axis
from teleop.sinks.connection import Answer, Connection
from teleop.sinks.preflight import Site, mode_refusals, mode_warnings
from teleop.sinks.telemetry import Telemetry

Deflections = Mapping[Axis, float]
STANDBY_WITHIN = 0.2  # s: an older word of standing on the ground is none to touch the motors by
OBTAIN_AGAIN = 0.5  # s between two requests for control: osdk-facts.md, Link and frame
BACK_ALONE = "the drone goes back to its RC by itself, a second after the last sticks that it heard"
LOST_ALONE = "a second after the last sticks that it heard, the drone behaves as without any RC"
MOVE_ALONE = "what the drone does then is not known: its pilot has to take it, by leaving F"
GESTURE = 2.0  # s for which the arm gesture is made, at most


class Grip(Protocol):
    """One way to hold a drone; `what` is what is taken, `period` is s between two frames."""

    what: str
    period: float
    say: Callable[[str], object]
    alone: str  # what becomes of the drone when nothing more reaches it

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:
        """Why the drone cannot be held so now."""
        ...

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]: ...

    def take(self, seen: Telemetry, now: float) -> None: ...

    def drive(self, sticks: Deflections, seen: Telemetry, now: float) -> None:
        """Send the sticks as they are."""
        ...

    def neutral(self, seen: Telemetry, now: float) -> None:
        """Send what leaves the drone where it is."""
        ...

    def give_back(self, now: float) -> None: ...

    def held(self, seen: Telemetry, now: float) -> bool | None:
        """Whether the drone says that it is held so, None where it says nothing."""
        ...

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        """Do as an operator's word says; what is to be said of it. Raises KeyError for a word that means nothing."""
        ...


class VirtualRcGrip:
    """The virtual RC: sticks, and the switches as an operator sets them. Neutral is P mode, gear down."""

    what, period = "virtual RC", 0.05

    def __init__(self, connection: Connection, back_to_rc: bool, go_home: int | None) -> None:
        self._connection, self._back_to_rc, self._go_home = connection, back_to_rc, go_home
        self.say: Callable[[str], object] = lambda _text: None
        self._switches = NEUTRAL
        self._gesture_end = -math.inf
        self.alone = BACK_ALONE if back_to_rc else LOST_ALONE
        self._words = {
            **{f"mode-{mode.name.lower()}": {"mode": mode} for mode in ModeChannel},
            **{f"gear-{gear.name.lower()}": {"gear": gear} for gear in GearChannel},
            "home-off": {"go_home": CENTRE},
        }
        if go_home is not None:
            self._words["home"] = {"go_home": go_home}

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:  # noqa: ARG002 - those of every taking will do
        return iter(())

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]:
        if seen.get("control", now) is None:
            yield "the drone sends no control field: whether virtual RC is on will not be known"
        if not self._back_to_rc:
            yield "when virtual RC ends the drone will behave as without any RC (back_to_rc: false)"

    def take(self, seen: Telemetry, now: float) -> None:  # noqa: ARG002 - whatever it says
        self._switches, self._gesture_end = NEUTRAL, -math.inf
        self._connection.stream(VirtualRc(on=True, back_to_rc=self._back_to_rc))

    def drive(self, sticks: Deflections, seen: Telemetry, now: float) -> None:
        if now < self._gesture_end:
            if not not_in_standby(seen, now) and not any(sticks.values()):
                self._connection.stream(_with(self._switches, CORNERS))
                return
            self._gesture_end = -math.inf
        self._connection.stream(_with(self._switches, sticks))

    def neutral(self, seen: Telemetry, now: float) -> None:  # noqa: ARG002 - whatever it says
        self._switches, self._gesture_end = NEUTRAL, -math.inf
        self._connection.stream(NEUTRAL)

    def give_back(self, now: float) -> None:  # noqa: ARG002 - whenever it is
        self._connection.stream(VirtualRc(on=False, back_to_rc=self._back_to_rc))

    def held(self, seen: Telemetry, now: float) -> bool | None:
        control = seen.get("control", now)
        return None if control is None else control.virtual_rc

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        if word == "home" and self._go_home is None:
            return "go home: the profile does not say what its channel is to be (go_home)"
        if word in ARMING:
            if refusal := not_in_standby(seen, now):
                return f"{word} refused: {refusal}; in the air this would cut the motors"
            self._gesture_end = now + GESTURE
            return f"{word}: sticks in the corners for {GESTURE:g} s, while the drone says standby"
        self._switches = _replaced(self._switches, **self._words[word])
        return f"{word}: set"


ARMING: Mapping[str, ArmOrder] = {"arm": ArmOrder.ARM, "disarm": ArmOrder.DISARM}
CORNERS: Deflections = dict(zip(STICKS, (-1.0, -1.0, -1.0, 1.0), strict=True))
"""The gesture that starts and stops the motors, and in the air cuts them: virtual-rc.md, Example."""


def not_in_standby(seen: Telemetry, now: float) -> str:
    """Why motors must not be started or stopped now, "" when they may: the drone has to say standby, now."""
    status = seen.get("status", now, STANDBY_WITHIN)
    if status == FlightStatus.STANDBY:
        return ""
    return "the drone does not say its flight status" if status is None else f"the drone says {word_of(status)}"


def word_of(value: object) -> str:
    """A number that the drone sent, by its word where it has one."""
    return value.name.lower().replace("_", " ") if isinstance(value, IntEnum) else f"{value}"


def _with(switches: Sticks, sticks: Deflections) -> Sticks:
    roll, pitch, throttle, yaw = (CENTRE + round(DEFLECTION * max(-1.0, min(1.0, sticks[axis]))) for axis in STICKS)
    return _replaced(switches, roll=roll, pitch=pitch, throttle=throttle, yaw=yaw)


def _replaced(sticks: Sticks, **channels: int) -> Sticks:
    return Sticks(**{**{spec.name: getattr(sticks, spec.name) for spec in Sticks.layout.fields}, **channels})


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
        roll, pitch, throttle, yaw = (sticks[axis] for axis in STICKS)
        turn, rise = yaw * self._full["yaw"], throttle * self._full["vertical"]
        if self._combination.yaw == movement.Yaw.ANGLE:
            turn = math.remainder(heading + turn, 360.0)
        if self._combination.vertical == movement.Vertical.POSITION:
            rise = max(0.0, height + rise)
        return movement.Move(
            stable=self._combination.horizontal == movement.Horizontal.VELOCITY,
            frame=self._frame,
            yaw_control=self._combination.yaw,
            vertical=self._combination.vertical,
            horizontal=self._combination.horizontal,
            x=pitch * self._full["horizontal"],
            y=roll * self._full["horizontal"],
            z=rise,
            yaw=turn,
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
        elif code:
            self.say(f"{name}: refused, {word_of(code)}")


def attitude(quaternion: object) -> tuple[float, float, float]:
    """Roll, pitch and yaw in deg, from the ground frame (north, east, down) to the body's."""
    w, x, y, z = (getattr(quaternion, name) for name in ("q0", "q1", "q2", "q3"))
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return math.degrees(roll), math.degrees(pitch), math.degrees(yaw)
