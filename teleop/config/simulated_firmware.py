"""How a simulated gimbal's firmware differs from DJI's document: part of the `simulated` key of a gimbal in a profile.

One key for each thing that is not known of real gimbals (docs/explanation/untested.md); `teleop sim` has the same ones
as options.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from teleop.config.documents.base_model import Section
from teleop.config.wiring import Angle, AngleOrder, Sign

FocusMotorState = Literal["calibrated", "uncalibrated", "absent"]
BeyondStop = Literal["stop", "refuse"]
PositionUnderSpeed = Literal["obey", "ignore"]
Refusable = Literal["position", "speed", "stick", "mode"]


class SimulatedFirmwareSection(Section):
    """How the firmware of the simulated gimbal differs from the document."""

    signs: dict[Angle, Sign] = Field(default_factory=dict)
    """-1 for an axis whose positions it counts the other way, and its speeds and reports with them."""
    speed_signs: dict[Angle, Sign] = Field(default_factory=dict)
    """-1 for an axis whose speeds it counts the other way than its positions; unless given, as the profile has it."""
    report_signs: dict[Angle, Sign] = Field(default_factory=dict)
    """The same for the angles that it reports."""
    legacy_replies: bool = False
    """Replies without set and id, and those with angles without their type, as of old firmware."""
    bare_replies: bool = False
    """Replies without set and id."""
    legacy_order: AngleOrder = "yaw-roll-pitch"
    """Order of the angles in replies of old firmware; all-yaw-pitch-roll: in every reply."""
    silent_angles: bool = False
    """No reply to questions for the angles."""
    reply_delay: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Time by which replies come late, 0..1 s."""
    push_rate: Annotated[float, Field(gt=0, le=100)] = 10.0
    """Pushes of angles per second (Hz), once they are on."""
    push_reply_bit: bool = False
    """Pushes have the reply bit."""
    short_push: bool = False
    """Pushes of 25 bytes: flags, yaw, roll, pitch."""
    silent_pushes: bool = False
    """No pushes, although they are on."""
    ignore_speed: bool = False
    """Speed commands are answered and do nothing."""
    stick_speed: dict[Angle, Annotated[float, Field(gt=0, le=360)]] = Field(default_factory=dict)
    """Speed at full deflection of the joystick, in deg/s; pan and tilt 60, roll 30 unless given."""
    beyond_stop: BeyondStop = "stop"
    """A position beyond a mechanical stop: it goes to the stop, or refuses."""
    position_under_speed: PositionUnderSpeed = "obey"
    """A position while speed control is taken over: it is obeyed, or answered and ignored."""
    roll_error: Annotated[float, Field(ge=-30, le=30)] = 0.0
    """How far from level the roll is left after speed control, in deg."""
    pitch_max: Annotated[int, Field(ge=1, le=179)] = 145
    """Upper limit of pitch that it reports, in deg; 155 as an RS 5."""
    reaction: Annotated[float, Field(ge=0, lt=60)] = 0.0
    """Time from a command to anything of it, in s, for all axes."""
    autotune_needs_type: bool = False
    """Automatic tuning starts with type 1 only, as the document has it; type 0 was seen to work."""
    refuses: list[Refusable] = Field(default_factory=list)
    """Commands that it refuses: position, speed, stick, mode."""
    focus_motor: FocusMotorState = "calibrated"
    """State of the focus motor; one that is not calibrated ignores positions."""
    ignore_zero_focus: bool = False
    """The focus motor ignores position 0."""
