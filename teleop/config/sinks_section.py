"""The sinks of a profile: the keys of each kind of device beside its link.

How fast a drone flies has no defaults, because only its pilot knows what is slow enough.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from teleop.config.documents.base_model import NoTruth, Section
from teleop.config.simulated_section import SimulatedSection
from teleop.config.wiring import Angle, AngleOrder, Sign, Wiring
from teleop.core.axes import STICKS, Axis

DRONES = ("virtual-rc", "flight")
Magnitude = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Share = Annotated[float, Field(gt=0, le=1)]
Rate = Annotated[Literal[1, 2, 4, 5, 10, 20, 25, 50, 100], NoTruth]  # Hz: whole numbers of the loop's ticks
Channel = Annotated[int, Field(ge=364, le=1684)]  # docs/protocol-facts.md
LowBattery = Annotated[int, Field(ge=10, le=90)]

MOVES: Mapping[str, Sequence[Axis]] = {
    "gimbal": (Axis.PAN, Axis.TILT, Axis.ROLL),  # unless its mapping says otherwise
    "focus": (Axis.FOCUS,),
    "camera": (),
    "virtual-rc": STICKS,
    "flight": STICKS,
}
"""The axes that each type of sink can move."""


class GainsSection(Section):
    """How strongly the measured error is corrected."""

    proportional: Annotated[float, Field(ge=0, le=20)] = 3.0
    """Correction in deg/s per deg of error; 0 turns it off."""
    integral: Annotated[float, Field(ge=0, le=20)] = 2.0
    """Correction in deg/s2 per deg of error; 0 turns it off."""


class MountSection(Section):
    """How the gimbal is mounted."""

    yaw: Annotated[float, Field(ge=-360, le=360)] = 0.0
    """The yaw in deg that the gimbal reports where pan is 0: 180 for one that was mounted or started turned round."""


class GimbalSection(Section):
    """Pan, tilt and roll of a gimbal over the R SDK."""

    RENAMED: ClassVar = {"follow": "max_following_error"}

    type: Literal["gimbal"]
    """Pan, tilt and roll of a DJI gimbal over the R SDK."""
    link: str
    """Name of the link that the device is on."""
    mode: Literal["position", "speed", "stick"]
    """The command stream: positions, speeds, or deflections of the gimbal's joystick."""
    rate: Rate
    """Commands per second (Hz)."""
    delay: Annotated[float, Field(ge=0, le=0.5)] | None = None
    """How much later than commanded the gimbal moves, in s; null: found out while it moves, 0 in mode position."""
    payload: Annotated[str, Field(max_length=40)] = ""
    """What is on the gimbal, as `fx3-24mm`: what is found of how its axes answer is kept for each payload by itself."""
    gains: GainsSection = GainsSection()
    """Gains of the correction from measured angles, for the modes speed and stick."""
    max_following_error: Annotated[float, Field(gt=0, le=180)] = 5.0
    """Largest permitted distance between commanded and measured angle, in deg; beyond it a run stops."""
    signs: dict[Angle, Sign] = Field(default_factory=dict)
    """-1 for an axis whose firmware counts the other way."""
    speed_signs: dict[Angle, Sign] = Field(default_factory=dict)
    """As `signs`, for speeds only; needed where the gimbal counts speeds otherwise than positions."""
    report_signs: dict[Angle, Sign] = Field(default_factory=dict)
    """As `signs`, for reported angles only; needed where they are counted otherwise than positions."""
    legacy_angles: AngleOrder = "yaw-roll-pitch"
    """Order of the angles in replies of old firmware; all-yaw-pitch-roll: in every reply, whatever the firmware."""
    mount: MountSection = MountSection()
    """How the gimbal is mounted; an underslung one may report a yaw of 180 straight ahead."""
    mapping: dict[Literal["yaw", "roll", "pitch"], Angle] = Field(
        default_factory=lambda: {"yaw": "pan", "roll": "roll", "pitch": "tilt"}
    )
    """The axis of each of the gimbal's angles; an angle that is left out is not driven."""

    full_stick: dict[Angle, Magnitude] = Field(default_factory=dict)
    """Speed at full deflection by the gimbal's own settings, in deg/s, for mode stick."""
    simulated: SimulatedSection = SimulatedSection()
    """How the simulated gimbal of a `sim:` link, and of `teleop sim`, moves and reports."""

    @property
    def axes(self) -> Sequence[Axis | None]:
        """The axes of the gimbal's yaw, roll and pitch."""
        mapped = (self.mapping.get(name) for name in ("yaw", "roll", "pitch"))
        return [None if axis is None else Axis(axis) for axis in mapped]

    @property
    def wiring(self) -> Wiring:
        signs, speed_signs, report_signs = (
            {Axis(axis): sign for axis, sign in each.items()}
            for each in (self.signs, self.speed_signs, self.report_signs)
        )
        return Wiring(self.axes, signs, speed_signs, report_signs, self.mount.yaw)

    def sign_line(self, axis: Axis) -> str:
        """What this section needs when `axis` goes the other way than it is sent in this mode."""
        in_speeds = self.mode != "position"
        key, written = ("speed_signs", self.speed_signs) if in_speeds else ("report_signs", self.report_signs)
        now = self.wiring.speed_sign(axis) if in_speeds else self.wiring.report_sign(axis)
        signs = {**written, axis.value: -now}
        return f"{key}: {{{', '.join(f'{name}: {sign}' for name, sign in signs.items())}}}"

    @property
    def pitch_and_roll(self) -> tuple[Axis, Axis] | None:
        """The axes of the gimbal's pitch and roll, None where it drives only one of them."""
        _, roll, pitch = self.axes
        return None if pitch is None or roll is None else (pitch, roll)

    def order_line(self, bare: bool) -> str:
        """What this section needs when pitch and roll are exchanged in replies, `bare` ones of old firmware or not."""
        exchanged = self.legacy_angles == "all-yaw-pitch-roll" or (bare and self.legacy_angles == "yaw-pitch-roll")
        order = "yaw-roll-pitch" if exchanged else "yaw-pitch-roll" if bare else "all-yaw-pitch-roll"
        return f"legacy_angles: {order}"

    def full(self, axis: Axis, velocity: float) -> float:
        """What full deflection gives an axis whose own velocity is `velocity`, both in deg/s."""
        return {Axis(name): full for name, full in self.full_stick.items()}.get(axis, velocity)


class FocusSection(Section):
    """The focus motor on the gimbal's bus."""

    RENAMED: ClassVar = {"follow": "max_following_error"}

    type: Literal["focus"]
    """The focus motor on the gimbal's bus."""
    link: str
    """Name of the link that the device is on."""
    rate: Rate
    """Commands per second (Hz)."""
    max_following_error: Share = 0.1
    """Largest permitted distance between commanded and measured focus, 0 to 1; beyond it a run stops."""


class CameraSection(Section):
    """The camera that the gimbal controls: record, stop, shutter."""

    type: Literal["camera"]
    """The camera that the gimbal controls: record, stop, shutter."""
    link: str
    """Name of the link that the device is on."""


class VirtualRcSection(Section):
    """A Matrice 100 flown by virtual RC."""

    type: Literal["virtual-rc"]
    """A Matrice 100 flown as by its remote control."""
    link: str
    """Name of the link that the device is on."""
    encrypted: bool = False
    """Encrypt what is sent, with the app's key."""
    back_to_rc: bool = True
    """Whether the drone obeys its RC again when virtual RC ends; false: as if it had lost its RC."""
    rate: Literal[20] = 20  # Hz: docs/protocol-facts.md
    """Stick commands per second (Hz): always 20."""
    low_battery: LowBattery = 25
    """Battery level in % below which the drone is not taken and control is released."""
    go_home: Channel | None = None
    """Channel value that sends the drone home, 364 to 1684; null for none."""


class FullScaleSection(Section):
    """What a full stick gives."""

    horizontal: Magnitude
    """A full right stick: m/s, deg or m, by `mode`."""
    vertical: Magnitude
    """A full throttle stick: m/s or m, by `vertical`."""
    yaw: Magnitude
    """A full yaw stick: deg/s or deg, by `yaw`."""


class FlightSection(Section):
    """A drone flown by movement commands. `mode` is what its horizontal sticks are, `vertical` and `yaw` the others.

    Modes 1 to 12 of the appendix can be had so; 13 and 14 are thrust, which has no neutral and so no stick.

    Angles, heights and offsets count from where the drone was when it was taken.

    `guidance` is whether Guidance is on board and set up, `indoors` whether it flies there.
    """

    RENAMED: ClassVar = {"full": "full_scale"}

    type: Literal["flight"]
    """A drone flown by movement commands."""
    link: str
    """Name of the link that the device is on."""
    encrypted: bool = False
    """Encrypt what is sent, with the app's key."""
    mode: Literal["velocity-body", "velocity-ground", "tilt", "tilt-ground", "offset-body", "offset-ground"]
    """What the horizontal sticks command: velocity, tilt or an offset, by the drone or by the ground."""
    vertical: Literal["velocity", "height"] = "velocity"
    """What the throttle stick commands: a velocity, or a height from where the drone was taken."""
    yaw: Literal["rate", "angle"] = "rate"
    """What the yaw stick commands: a rate, or an angle from where the drone was taken."""
    full_scale: FullScaleSection
    """What full deflection of each stick gives."""
    rate: Literal[50] = 50  # Hz: docs/protocol-facts.md
    """Movement commands per second (Hz): always 50."""
    guidance: bool = False
    """Whether Guidance is on board and set up."""
    indoors: bool = False
    """Whether the drone flies indoors."""
    low_battery: LowBattery = 25
    """Battery level in % below which the drone is not taken and control is released."""


SinkSection = GimbalSection | FocusSection | CameraSection | VirtualRcSection | FlightSection
