"""A DJI handheld gimbal that obeys nothing but R SDK frames: no I/O, no clock, no other way in.

It is the far end of the same Session as the program's own, so a mistake in the frames, the fields or their meaning
shows as a wrong angle, a refusal or silence. Which handler obeys a message is a table, put together from the parts of
the gimbal; what no part knows, what is malformed and what has a value that the document does not list is a parse error,
and `refusals` has it with its reason. Reserved bits are not looked at where clients set them.

Every part is a function of time between commands, so looking often or seldom makes no difference.

What goes wrong with real ones can be asked for: a reboot, an axis held by hand, missing angle reports, the time that it
takes to react, and other dynamics, from the start or from any moment on.
"""

from __future__ import annotations

import random
from collections import Counter, deque
from collections.abc import Iterable, Sequence
from operator import itemgetter
from typing import Any

from teleop.dji.frame import Frame
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import FieldError, Message, Result, ReturnCode
from teleop.sim.gimbal.accessories import Camera, FocusMotor
from teleop.sim.gimbal.autotune import Autotune
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware
from teleop.sim.gimbal.gimbal_axes import Angles, GimbalAxes
from teleop.sim.gimbal.handlers import Answer, Handlers, without_reserved
from teleop.sim.gimbal.outgoing import Outgoing
from teleop.sim.gimbal.pushes import Beat, Due
from teleop.sim.gimbal.quirks import has_no_reply, pushed, replied
from teleop.sim.gimbal.settings import Settings
from teleop.sim.refusals import Refusals, Why, command_name

JOYSTICK_SPEED = 60.0, 30.0, 60.0  # deg/s of yaw, roll and pitch at full deflection
PUSH_RATE = 10.0  # Hz; it varies with the firmware, from 1 Hz up (docs/protocol-facts.md)

_MOTION = gimbal.Position, gimbal.Speed, gimbal.Joystick, gimbal.Mode
_REFUSABLE = {"position": gimbal.Position, "speed": gimbal.Speed, "stick": gimbal.Joystick, "mode": gimbal.Mode}
_READ_GENEROUSLY = gimbal.Joystick, gimbal.Dial
_REPLY_TYPE = 0x1F  # bits of cmd_type; 0 is the only type that is not answered: section 2.2


class SimulatedGimbal:
    """A gimbal with camera and focus motor. Angles and rates are (yaw, roll, pitch) in deg and deg/s.

    `boot` is where it is at first. `signs` are those of its firmware against `core.axes`, 1 or -1 for each axis.
    `lag` is the time constant of its speeds in s, `joystick_speed` the rates at full deflection. A `continuous` gimbal
    has no stops for yaw. `focus_speed` is in counts/s. With `bare_replies` it leaves set and id out of its replies, as
    firmware before 01.04.00.20 does. `push_rate` is in Hz, once the push is switched on. What moves it is carried out
    `reaction` seconds after it came. While `tells_angles` is False it neither answers for its angles nor pushes them.
    `firmware` is how else it differs from the document.

    `dynamics` are how each axis moves and reports, one for all or yaw, roll and pitch; they overrule `lag`. `changes`
    are when (s after it was first given a time) which take their place, as with another payload. `mount` is the yaw in
    deg to which the mount is turned at boot, `lost_readings` the share of angle reports that get lost.
    """

    def __init__(
        self,
        *,
        boot: tuple[float, float, float] = (0.0, 0.0, 0.0),
        signs: tuple[int, int, int] = (1, 1, 1),
        lag: float = 0.05,
        joystick_speed: tuple[float, float, float] = JOYSTICK_SPEED,
        continuous: bool = False,
        focus_speed: float = 4095.0,
        focus_calibrated: bool = True,
        push_rate: float = PUSH_RATE,
        bare_replies: bool = False,
        reaction: float = 0.0,
        version: str = "02.02.00.07",
        firmware: Firmware = DOCUMENTED,
        dynamics: Dynamics | Sequence[Dynamics] | None = None,
        changes: Iterable[tuple[float, Dynamics | Sequence[Dynamics]]] = (),
        mount: float = 0.0,
        lost_readings: float = 0.0,
    ) -> None:
        self.counts: Counter[str] = Counter()  # messages by name, as they were understood
        self.follow = gimbal.FollowMode.YAW
        self.settings = Settings(version)
        self.refusals = Refusals()
        own = _of_each(dynamics if dynamics is not None else Dynamics(lag=lag))
        self._head = GimbalAxes(
            *(Angles(*boot), Angles(*signs), lag, Angles(*(firmware.stick_speed or joystick_speed)), continuous),
            *(firmware, own, mount),
        )
        self._changes = deque(sorted(((time, _of_each(then)) for time, then in changes), key=itemgetter(0)))
        self._started: float | None = None  # s
        self._lost_readings = lost_readings
        self._chance = random.Random(1)  # losses repeat
        self._camera = Camera()
        calibrated = focus_calibrated and firmware.focus_motor == "calibrated"
        self._focus = FocusMotor(focus_speed, calibrated, firmware.focus_motor == "absent", firmware.ignores_zero_focus)
        self._tuning = Autotune(firmware.autotune_needs_type)
        self.tells_angles = True
        self._push_rate = push_rate
        self._reaction = reaction
        self._to_come: deque[tuple[float, Message]] = deque()  # what has still to be reacted to, and when
        self._booted = float("-inf")  # s
        self._bare_replies = bare_replies or firmware.legacy_replies or firmware.bare_replies
        self._firmware = firmware
        self._push: Beat | None = None
        self._session = Session()
        self._now = float("-inf")
        self._outgoing = Outgoing(firmware.reply_delay)
        self._handlers: Handlers = {
            gimbal.PushSettings: self._switch_push,
            gimbal.Mode: self._change_mode,
        }
        for part in (self._head, self._camera, self._focus, self._tuning, self.settings):
            self._handlers |= part.handlers

    @property
    def angles(self) -> Angles:
        """Where it is at the last time it was given, exact; an axis without stops counts its turns."""
        return self._head.angles(self._now)

    @property
    def rates(self) -> Angles:
        """How fast it turns at the last time it was given."""
        return self._head.rates(self._now)

    @property
    def focus(self) -> float:
        """Where the focus motor is at the last time it was given: counts, 0 .. 4095, exact."""
        return self._focus.position(self._now)

    @property
    def controlled(self) -> bool:
        """Whether a speed command has taken over, and none has given back since."""
        return self._head.controlled

    @property
    def recording(self) -> bool:
        return self._camera.recording

    @property
    def shutter_count(self) -> int:
        return self._camera.shutter_count

    def receive(self, data: bytes, now: float) -> None:
        """Obeys the frames that `data`, arriving at `now` (s, never going back), completes."""
        self._pass(now)
        if self._now < self._booted:
            return
        damage = self._session.last_damage
        for received in self._session.receive(data, self._now):
            frame = received.frame
            if frame.is_reply:
                self.refusals.add(now, command_name(received.message), Why.REPLY)
                continue
            self.counts[received.message.name] += 1
            answer = self._obey(received.message)
            answers = not isinstance(received.message, gimbal.Angles) or (
                self._tells_angles_now() and not self._firmware.silent_angles
            )
            if frame.cmd_type & _REPLY_TYPE and answers and not has_no_reply(received.message):
                self._reply(frame, answer)
        if self._session.last_damage is not damage and self._session.last_damage:
            self.refusals.add_damage(now, self._session.last_damage)

    def advance(self, now: float) -> bytes:
        """What it has sent up to `now`: replies, and pushes at their own times."""
        self._pass(now)
        return self._outgoing.taken(self._now)

    def reboot(self, now: float, seconds: float) -> None:
        """It goes out, hears and says nothing for so long, and is then as at first."""
        self._pass(now)
        self._booted = now + seconds
        self._push = None
        self._to_come.clear()
        self._outgoing.clear()
        self._head.boot()

    def hold(self, now: float, *, yaw: bool = False, roll: bool = False, pitch: bool = False) -> None:
        """A hand holds these axes from `now` on, and lets go of the others."""
        self._pass(now)
        self._head.hold(now, Angles(yaw, roll, pitch))

    def change(self, now: float, dynamics: Dynamics | Sequence[Dynamics]) -> None:
        """It moves and reports so from `now` on, as with another payload; commands before keep what they had."""
        self._pass(now)
        self._head.change(_of_each(dynamics))

    def _pass(self, now: float) -> None:
        self._now = max(self._now, now)
        self._started = self._now if self._started is None else self._started
        while self._changes and self._changes[0][0] <= self._now - self._started:
            self._head.change(self._changes.popleft()[1])
        while self._to_come and self._to_come[0][0] <= self._now:
            time, message = self._to_come.popleft()
            self._handlers[type(message)](message, time)
        due: list[Due] = self._tuning.due(self._now)
        if self._push and not self._firmware.silent_pushes:
            beats = self._push.due(self._now)
            due += [(time, self._parameters(time)) for time in beats if self._tells_angles_now()]
        for _, push in sorted(due, key=itemgetter(0)):
            self._outgoing.push(pushed(self._session.push(push), push, self._firmware))

    def _tells_angles_now(self) -> bool:
        return self.tells_angles and not (self._lost_readings and self._chance.random() < self._lost_readings)

    def _obey(self, message: Message) -> Answer:
        handler = self._handlers.get(type(message))
        if handler is None:
            known = any(cls.set_and_id == message.data()[:2] for cls in self._handlers)
            return self._refused(message, ReturnCode.PARSE_ERROR, Why.LENGTH if known else Why.UNKNOWN)
        if not isinstance(message, _READ_GENEROUSLY):
            try:
                without_reserved(message).check()
            except FieldError as error:
                return self._refused(message, ReturnCode.PARSE_ERROR, Why.RANGE, str(error).partition(": ")[2])
        if isinstance(message, _MOTION) and (self.settings.asleep or self._tuning.running(self._now)):
            doing = "its motors are off" if self.settings.asleep else "it is calibrating"
            return self._refused(message, ReturnCode.FAILED, Why.STATE, doing)
        if any(isinstance(message, _REFUSABLE[name]) for name in self._firmware.refuses):
            return self._refused(message, ReturnCode.FAILED, Why.STATE, "this firmware does not take it")
        if isinstance(message, _MOTION) and self._reaction:
            self._to_come.append((self._now + self._reaction, message))
            return ReturnCode.OK
        answer = handler(message, self._now)
        if self.settings.asleep:
            self._head.halt(self._now)
        if isinstance(answer, ReturnCode) and answer != ReturnCode.OK:
            self._refused(message, answer, Why.STATE if answer == ReturnCode.FAILED else Why.RANGE)
        return answer

    def _refused(self, message: Message, code: ReturnCode, why: Why, detail: str = "") -> ReturnCode:
        self.refusals.add(self._now, command_name(message), why, detail)
        return code

    def _reply(self, frame: Frame, answer: Answer) -> None:
        message = Result(answer) if isinstance(answer, ReturnCode) else answer
        message = replied(message, self._firmware, self._bare_replies)
        self._outgoing.reply(self._session.reply(frame, message, bare=self._bare_replies), self._now)

    def _switch_push(self, message: gimbal.PushSettings, now: float) -> Answer:
        if message.switch == gimbal.Switch.ON and self._push is None:
            self._push = Beat(now, 1.0 / self._push_rate)
        elif message.switch == gimbal.Switch.OFF:
            self._push = None
        return ReturnCode.OK

    def _change_mode(self, message: gimbal.Mode, now: float) -> Answer:
        if message.action == gimbal.CenterAction.NONE:
            self.follow = gimbal.FollowMode(message.mode)
        else:
            yaw = 180.0 if message.action == gimbal.CenterAction.SELFIE else 0.0
            self._head.turn(now, Angles(yaw, 0.0, 0.0))
        return ReturnCode.OK

    def _parameters(self, time: float) -> gimbal.Push:
        angles: dict[str, Any] = self._head.reported(time)._asdict()
        return gimbal.Push(
            angles_valid=True,
            limits_valid=True,
            stiffness_valid=True,
            **angles,
            **{f"joint_{axis}": angle for axis, angle in angles.items()},
            **self._head.limits(),
            **{f"{axis}_stiffness": value for axis, value in self.settings.stiffness.items()},
        )


def _of_each(dynamics: Dynamics | Sequence[Dynamics]) -> Sequence[Dynamics]:
    """Of yaw, roll and pitch."""
    return [dynamics] * len(Angles._fields) if isinstance(dynamics, Dynamics) else dynamics
