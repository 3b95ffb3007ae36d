"""A gimbal on the bench: what it is sent, what it answers, where it is, and how it is brought to rest.

Everything is in the gimbal's own order and signs (yaw, roll, pitch, as the document has them): what a profile makes of
that is what is to be found. Positions are sent as increments, so that nothing leaps whatever the signs are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from teleop.commission.gimbal.motion import home
from teleop.commission.gimbal.places import ANGLES
from teleop.commission.gimbal.rest import Rest
from teleop.commission.gimbal.track import Track
from teleop.commission.step import Script
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import half_turn
from teleop.core.errors import DeviceError
from teleop.devices.connection import Answer, Connection
from teleop.devices.gimbal.position import own_version
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.dji.gimbal.session import Received
from teleop.dji.message import Message

ASK = 0.02  # s between two questions for the angles
GREETING = 1.0  # s between two pushes of our own version: V2.5, section 2.3.4.10
ALIVE = 0.25  # s between two questions for the version, where those for the angles stay unanswered
SAME_PLACE = 0.25  # deg: nearer than that an axis is where it was
REQUESTS = (
    gimbal.Position,
    gimbal.Speed,
    gimbal.Angles,
    gimbal.Limits,
    gimbal.Stiffness,
    gimbal.PushSettings,
    gimbal.Version,
    gimbal.Parameters,
    gimbal.Mode,
    camera.Command,
    camera.Status,
    focus.Get,
)


class GimbalBench(Track):
    """`open_link` opens the link, and closes the one before. `section` says which axes the profile drives.

    While `quiet` nothing is sent.
    """

    def __init__(self, open_link: Callable[[], Connection], section: GimbalSection) -> None:
        super().__init__()
        self._open = open_link
        self.section = section
        self.quiet = True
        self.knows_order = False
        self.position_signs = [1, 1, 1]  # of the reading for a positive position; likewise below for a positive speed
        self.speed_signs: list[int | None] = [None, None, None]
        self.obeys_position = [False, False, False]
        self.answered: dict[int, Answer] = {}
        self.frames: list[tuple[float, Received]] = []  # all that came, while `keeps_frames`
        self.keeps_frames = False
        self.begin: tuple[float, float, float] | None = None
        self.back_speed = 4.0  # deg/s of the way back
        self.full_stick = [0.0, 0.0, 0.0]  # deg/s of the reading at full deflection, with its sign; 0 where unknown
        self.pushes_on = False
        self._in_vain: tuple[object, ...] = ()  # what was known when the way back led nowhere
        self._reach: float | None = None
        self._reach_from: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self._ask_at = self._greet_at = self._alive_at = -math.inf
        self.reopen()

    # what the runner needs

    def poll(self, now: float) -> None:
        """Raises LinkError as the link does, DeviceError when an axis goes further than it was sent."""
        self.now = now
        self.connection.poll(now)
        self.forget_old()
        if not self.quiet:
            self._ask()
        self._check_reach()

    def release(self, now: float) -> float | None:
        self._reach = None
        return self.rest.release(now)

    def release_at_once(self) -> None:
        """One attempt to end whatever is in force, without waiting for anything."""
        if not self.quiet:
            self.rest.at_once(self.now)

    def reopen(self) -> None:
        self.connection = self._open()
        self._ask_at = self._greet_at = self._alive_at = -math.inf
        self.rest = Rest(self)
        for request in REQUESTS:
            self.connection.on_answer(request, self._answered)
        self.listen(self.connection)
        self.connection.on_received(self._received)

    def displaced(self) -> str:
        if self.begin is None or self.last is None:
            return ""
        ways = self.ways_back()
        return ", ".join(f"{self.name(index)} {abs(way):.1f} deg" for index, way in ways.items())

    # where it is

    @property
    def driven(self) -> Sequence[int]:
        """The gimbal's angles that the profile drives, by their places in yaw, roll, pitch."""
        return [index for index, axis in enumerate(self.section.axes) if axis is not None]

    def name(self, index: int) -> str:
        axis = self.section.axes[index]
        return ANGLES[index] if axis is None else axis.value

    def ways_back(self) -> Mapping[int, float]:
        """How far (deg) each driven angle is from where it began, those that are there left out."""
        if self.begin is None:
            return {}
        here, near = self.mean(), SAME_PLACE + self.noise
        ways = {index: half_turn(self.begin[index] - here[index]) for index in self.driven}
        return {index: way for index, way in ways.items() if abs(way) > near}

    def restore(self) -> Script:
        """Where that led nowhere it is not tried again, until something more is known of what moves it."""
        known = (*self.obeys_position, *self.speed_signs, *self.full_stick)
        if known != self._in_vain:
            yield from home(self)
            self._in_vain = known if self.ways_back() else ()
        return ()

    def mark_begin(self) -> None:
        """It begins here."""
        self.begin = self.mean()

    def exchange(self) -> None:
        """Roll and pitch are exchanged in the replies: what was read so far was the other way round."""
        self.swapped = not self.swapped
        if self.begin is not None:
            yaw, second, third = self.begin
            self.begin = yaw, third, second

    def allow(self, reach: float) -> None:
        """From now on no angle goes further than `reach` (deg) from here, and a little.

        Raises DeviceError where an angle is that far from where it began already: it must not wander off step by step.
        """
        for index, way in self.ways_back().items():
            if abs(way) > reach:
                place = f"{self.name(index)} is {abs(way):.0f} deg from where it began, and nothing brings it back"
                raise DeviceError(f"{place}: turn it back by hand, then repeat this step")
        self._reach, self._reach_from = reach + 1.0 + 4 * self.noise, self.mean()

    def _check_reach(self) -> None:
        here = self.last
        if self._reach is None or here is None:
            return
        for index, (angle, start) in enumerate(zip(here, self._reach_from, strict=True)):
            if abs(moved := half_turn(angle - start)) > self._reach:
                self._reach = None
                raise DeviceError(f"{self.name(index)} moved {abs(moved):.1f} deg, more than it was sent: stopped")

    # what it is sent

    def request(self, message: Message) -> int:
        self.rest.note(message, self.now)
        return self.connection.request(message, self.now)

    def stream(self, message: Message) -> None:
        self.rest.note(message, self.now)
        self.connection.stream(message)

    def increment(self, index: int, way: float, seconds: float) -> int:
        """Turn one angle by `way` (deg, in the signs of positions)."""
        return self._position(index, way, seconds, absolute=False)

    def target(self, index: int, angle: float, seconds: float) -> int:
        """Turn one angle to `angle` (deg, as positions count it)."""
        return self._position(index, half_turn(angle), seconds, absolute=True)

    def _position(self, index: int, angle: float, seconds: float, *, absolute: bool) -> int:
        yaw, roll, pitch = (angle if each == index else 0.0 for each in range(3))
        no_yaw, no_roll, no_pitch = (each != index for each in range(3))
        ignored = no_yaw, no_roll, no_pitch
        message = gimbal.Position(yaw, roll, pitch, absolute, *ignored, time_for_action=round(seconds, 1))
        return self.request(message)

    def speed(self, index: int, value: float) -> int:
        """Turn one angle at `value` deg/s, in the signs of speeds; 0 for the others."""
        yaw, roll, pitch = (round(value, 1) if each == index else 0.0 for each in range(3))
        return self.request(gimbal.Speed(yaw, roll, pitch, take_over=True, ignore_focal_length=True))

    def push(self, index: int, deflection: int) -> None:
        """Deflect the joystick for one angle; -15000..15000."""
        yaw, roll, pitch = (deflection if each == index else 0 for each in range(3))
        self.stream(gimbal.Joystick(pitch=pitch, roll=roll, yaw=yaw))

    def code(self, sequence: int) -> int | None:
        """The return code of the answer to a request, None while there is none."""
        answer = self.answered.get(sequence)
        reply = None if answer is None else answer.reply
        return getattr(reply, "return_code", None) if reply is not None else None

    # what comes in

    def _ask(self) -> None:
        now = self.now
        if now >= self._greet_at - 1e-6:
            self._greet_at = now + GREETING
            self.connection.stream(gimbal.VersionPush(version=own_version()))
        if now >= self._ask_at - 1e-6:
            self._ask_at = now + ASK
            self.connection.request(gimbal.Angles(AngleKind.ATTITUDE), now)
        if self.is_silent and now >= self._alive_at - 1e-6:
            self._alive_at = now + ALIVE
            self.connection.request(gimbal.Version(), now)
            if not self.pushes_on:
                self.pushes_on = True
                self.connection.request(gimbal.PushSettings(gimbal.Switch.ON), now)

    def _answered(self, answer: Answer) -> None:
        self.answered[answer.sequence] = answer
        if len(self.answered) > 500:
            del self.answered[next(iter(self.answered))]

    def _received(self, received: Received, now: float) -> None:
        if self.keeps_frames:
            self.frames.append((now, received))
