"""The options of `teleop sim`: how the simulated devices differ from the documents."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal, get_args

from cyclopts import Group, Parameter

from teleop.cli.codec.drone_options import cipher_of
from teleop.cli.sim_dynamics import numbers_by_axis
from teleop.config.simulated_firmware import Refusable
from teleop.core.errors import UsageError
from teleop.dji.drone.encryption import Cipher
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.drone.settings import MOVEMENT_TIMEOUT, VIRTUAL_RC_TIMEOUT, DroneSettings
from teleop.sim.gimbal.device import JOYSTICK_SPEED, PUSH_RATE, SimulatedGimbal
from teleop.sim.gimbal.firmware import DOCUMENTED, BeyondStop, Firmware, Order, PositionUnderSpeed

DRONE = Group("Drone", sort_key=1)
GIMBAL = Group("Gimbal", sort_key=2)
_FIELDS: Mapping[str, str] = {
    "ignore_speed": "ignores_speed",
    "ignore_zero_focus": "ignores_zero_focus",
}
"""Options whose field of the firmware has another name."""
_AXES = "yaw", "roll", "pitch"
_SIGNS = {"1": 1, "+1": 1, "-1": -1}


def flag(group: Group, about: str) -> Parameter:
    return Parameter(group=group, help=about, negative=(), show_default=False)


@Parameter(name="*")
@dataclass(frozen=True)
class DroneSim:
    """How the simulated drones behave; without options, as far as it is known of a Matrice 100."""

    drone: Annotated[bool, flag(DRONE, "Simulate a drone too, on a serial port that is made for it.")] = False
    key_file: Annotated[
        Path | None,
        Parameter(
            metavar="FILE",
            group=DRONE,
            help="File with the app's key, 64 hexadecimal digits: after activation everything is encrypted.",
            show_default=False,
        ),
    ] = None
    answer_delay: Annotated[
        float, Parameter(metavar="SECONDS", group=DRONE, help="Seconds by which acknowledgements come late.")
    ] = 0.0
    immediate_control: Annotated[
        bool, flag(DRONE, "Confirm obtain and release at once; a real drone answers 3 or 4 first.")
    ] = False
    silent_until_activated: Annotated[
        bool, flag(DRONE, "Neither broadcast nor take push frequencies before activation.")
    ] = False
    virtual_rc_timeout: Annotated[
        float, Parameter(metavar="SECONDS", group=DRONE, help="Seconds without sticks after which virtual RC ends.")
    ] = VIRTUAL_RC_TIMEOUT
    movement_timeout: Annotated[
        float, Parameter(metavar="SECONDS", group=DRONE, help="Seconds for which a movement command is obeyed.")
    ] = MOVEMENT_TIMEOUT
    mirror_rc: Annotated[
        bool, flag(DRONE, "Broadcast the virtual RC's channels as the RC's while virtual RC is on.")
    ] = False

    def made(self, now: float) -> SimulatedDrone:
        """A drone with these settings. Raises UsageError."""
        for name in ("answer_delay", "virtual_rc_timeout", "movement_timeout"):
            if not 0 <= getattr(self, name) < 60:
                raise UsageError(f"--{name.replace('_', '-')} must be 0..60 s, not {getattr(self, name):g}")
        settings = DroneSettings(
            not self.immediate_control,
            not self.silent_until_activated,
            self.answer_delay,
            self.virtual_rc_timeout,
            self.movement_timeout,
        )
        return SimulatedDrone(now=now, mirrors=self.mirror_rc, cipher=self._cipher(), settings=settings)

    def _cipher(self) -> Cipher | None:
        make = cipher_of(self.key_file) if self.key_file else None
        return make() if make else None


@Parameter(name="*")
@dataclass(frozen=True)
class GimbalSim:
    """How the simulated gimbals behave; without options, as the R SDK document V2.5 says."""

    signs: Annotated[
        str,
        Parameter(
            metavar="AXIS=SIGN",
            group=GIMBAL,
            help="Axes that it counts the other way: yaw=-1 or yaw=-1,roll=-1.",
            show_default=False,
        ),
    ] = ""
    speed_signs: Annotated[
        str,
        Parameter(
            metavar="AXIS=SIGN",
            group=GIMBAL,
            help="Axes whose speed has another sign than their angle: yaw=-1 or yaw=-1,roll=-1.",
            show_default=False,
        ),
    ] = ""
    report_signs: Annotated[
        str,
        Parameter(
            metavar="AXIS=SIGN", group=GIMBAL, help="The same for the angles that it reports.", show_default=False
        ),
    ] = ""
    legacy_replies: Annotated[
        bool, flag(GIMBAL, "Reply without set and id, to 0x02 without the type byte too, as old firmware does.")
    ] = False
    legacy_order: Annotated[
        Order,
        Parameter(group=GIMBAL, help="The order of the angles in a legacy reply; all-...: in every reply."),
    ] = "yaw-roll-pitch"
    push_rate: Annotated[float, Parameter(metavar="HZ", group=GIMBAL, help="Pushes a second, once they are on.")] = (
        PUSH_RATE
    )
    push_reply_bit: Annotated[bool, flag(GIMBAL, "Push with the reply bit set.")] = False
    short_push: Annotated[bool, flag(GIMBAL, "Push 25 bytes: flags, yaw, roll, pitch.")] = False
    ignore_speed: Annotated[
        bool, flag(GIMBAL, "Answer speed commands and do nothing, as some RS 3 Pro and RS 4 Pro firmware does.")
    ] = False
    focus_motor: Annotated[
        Literal["calibrated", "uncalibrated", "absent"], Parameter(group=GIMBAL, help="The focus motor.")
    ] = "calibrated"
    ignore_zero_focus: Annotated[bool, flag(GIMBAL, "Let the focus motor ignore position 0.")] = False
    roll_error: Annotated[
        float,
        Parameter(
            metavar="DEGREES", group=GIMBAL, help="Degrees from level at which roll is left after speed control."
        ),
    ] = 0.0
    pitch_max: Annotated[
        int, Parameter(metavar="DEGREES", group=GIMBAL, help="The upper limit of pitch to report; an RS 5: 155.")
    ] = 145
    reaction: Annotated[
        float, Parameter(metavar="SECONDS", group=GIMBAL, help="Seconds from a command to the motion.")
    ] = 0.0
    bare_replies: Annotated[bool, flag(GIMBAL, "Reply without set and id.")] = False
    silent_angles: Annotated[bool, flag(GIMBAL, "Do not reply to questions for the angles.")] = False
    reply_delay: Annotated[
        float, Parameter(metavar="SECONDS", group=GIMBAL, help="Seconds by which replies come late, 0..1.")
    ] = 0.0
    silent_pushes: Annotated[bool, flag(GIMBAL, "Do not push angles, although pushes are on.")] = False
    stick_speed: Annotated[
        str,
        Parameter(
            metavar="VALUE|AXIS=VALUE",
            group=GIMBAL,
            help="Speed at full deflection of the joystick, above 0 and at most 360 deg/s.",
            show_default=False,
        ),
    ] = ""
    beyond_stop: Annotated[
        BeyondStop, Parameter(group=GIMBAL, help="A position beyond a stop: go to the stop, or refuse it.")
    ] = "stop"
    position_under_speed: Annotated[
        PositionUnderSpeed,
        Parameter(group=GIMBAL, help="A position while speed control is taken over: obey or ignore it."),
    ] = "obey"
    autotune_needs_type: Annotated[bool, flag(GIMBAL, "Start automatic tuning with type 1 only.")] = False
    refuses: Annotated[
        str,
        Parameter(
            metavar="COMMANDS",
            group=GIMBAL,
            help="Commands that it refuses: position, speed, stick, mode, with commas between.",
            show_default=False,
        ),
    ] = ""
    bus_errors: Annotated[
        float, Parameter(metavar="SHARE", group=GIMBAL, help="Share of the frames that end as error frames, 0..1.")
    ] = 0.0
    foreign_traffic: Annotated[
        bool, flag(GIMBAL, "Send on ids 0x530, 0x531 and 0x426 400 times a second, as gimbals do.")
    ] = False

    def made(
        self, settings: Mapping[str, Any] = MappingProxyType({}), profile: Firmware = DOCUMENTED
    ) -> SimulatedGimbal:
        """A gimbal with the settings and the firmware of its profile, but for the options given. Raises UsageError."""
        if not 0 < self.push_rate <= 100:
            raise UsageError(f"--push-rate must be above 0 and at most 100 Hz, not {self.push_rate:g}")
        if not 0 <= self.reaction < 60:
            raise UsageError(f"--reaction must be 0..60 s, not {self.reaction:g}")
        if not -30 <= self.roll_error <= 30:
            raise UsageError(f"--roll-error must be -30..30 deg, not {self.roll_error:g}")
        if not 0 < self.pitch_max < 180:
            raise UsageError(f"--pitch-max must be 1..179 deg, not {self.pitch_max}")
        if not 0 <= self.bus_errors <= 1:
            raise UsageError(f"--bus-errors must be 0..1, not {self.bus_errors:g}")
        if not 0 <= self.reply_delay <= 1:
            raise UsageError(f"--reply-delay must be 0..1 s, not {self.reply_delay:g}")
        given = {each.name: value for each in fields(self) if (value := getattr(self, each.name)) != each.default}
        made = {**settings, **{key: given.pop(key) for key in ("push_rate", "reaction") if key in given}}
        for option, field in _FIELDS.items():
            if option in given:
                given[field] = given.pop(option)
        if "signs" in given:
            made["signs"] = _signs("--signs", given.pop("signs"))
        for key in ("speed_signs", "report_signs"):
            if key in given:
                signs = _signs(f"--{key.replace('_', '-')}", given[key])
                given[key] = tuple(sign * of for sign, of in zip(signs, made.get("signs", (1, 1, 1)), strict=True))
        if "refuses" in given:
            given["refuses"] = _refused(given["refuses"])
        if "stick_speed" in given:
            given["stick_speed"] = _stick_speed(given["stick_speed"])
        for key in ("foreign_traffic", "bus_errors"):
            given.pop(key, None)
        return SimulatedGimbal(**made, firmware=replace(profile, **given))


def _refused(text: str) -> tuple[Refusable, ...]:
    """Raises UsageError."""
    known: Mapping[str, Refusable] = {name: name for name in get_args(Refusable)}
    names = list(filter(None, text.replace(" ", "").split(",")))
    for name in names:
        if name not in known:
            raise UsageError(f"--refuses {text}: write {', '.join(known)}, not {name}")
    return tuple(known[name] for name in names)


def _stick_speed(text: str) -> tuple[float, ...]:
    """Of yaw, roll and pitch. Raises UsageError."""
    values = numbers_by_axis("--stick-speed", text)
    for value in values.values():
        if not 0 < value <= 360:
            raise UsageError(f"--stick-speed must be above 0 and at most 360 deg/s, not {value:g}")
    return tuple(values.get(axis, usual) for axis, usual in zip(_AXES, JOYSTICK_SPEED, strict=True))


def _signs(option: str, text: str) -> tuple[int, int, int]:
    """Of yaw, roll and pitch. Raises UsageError."""
    signs = dict.fromkeys(_AXES, 1)
    for part in filter(None, text.replace(" ", "").split(",")):
        axis, _, sign = part.partition("=")
        if axis not in signs or sign not in _SIGNS:
            raise UsageError(f"{option} {text}: write yaw, roll or pitch with 1 or -1, as in yaw=-1,roll=1")
        signs[axis] = _SIGNS[sign]
    return signs["yaw"], signs["roll"], signs["pitch"]


DRONE_DEFAULTS, GIMBAL_DEFAULTS = DroneSim(), GimbalSim()
