"""How real gimbals differ from one another: the settings of a simulated one. Sources: docs/protocol-facts.md."""

from __future__ import annotations

from dataclasses import dataclass

from teleop.config.simulated_firmware import BeyondStop, FocusMotorState, PositionUnderSpeed, Refusable
from teleop.config.wiring import AngleOrder as Order


@dataclass(frozen=True)
class Firmware:
    """The defaults are those of V2.5.

    - `speed_signs`: of yaw, roll and pitch in speed commands (0x01, 0x0A) against `core.axes`, 1 or -1; None for the
      signs of the angles. Some gimbals have other ones: one driver negates roll in 0x01 alone. `report_signs` likewise
      of the angles that it reports and pushes.
    - `legacy_replies`: replies without set and id, that of 0x02 without the type byte too, its angles in `legacy_order`
      (yaw, roll, pitch by two sources; yaw, pitch, roll by one). With all-yaw-pitch-roll so are those of every reply.
      `bare_replies`: without set and id only. `silent_angles`: no reply to 0x02. `reply_delay`: s until a reply.
    - `silent_pushes`: none, although they are on.
    - `push_reply_bit`: pushes have CmdType 0x20. `short_push`: a push of 25 bytes (flags, yaw, roll, pitch).
    - `ignores_speed`: 0x01 is answered and does nothing, as some RS 3 Pro and RS 4 Pro firmware does.
    - `stick_speed`: full deflection of the joystick for yaw, roll and pitch, in deg/s; None for that of the gimbal.
    - `beyond_stop`: a position beyond a stop leads to the stop, or is refused. `position_under_speed`: a position while
      speed control is taken over is obeyed, or answered and ignored. The document says nothing of either.
    - `autotune_needs_type`: automatic tuning starts with type 1 only.
    - `focus_motor`: one that is not calibrated ignores positions; without one, it is answered that that failed.
      `ignores_zero_focus`: position 0 does nothing, as with some motors.
    - `roll_error`: how far from level (deg) the roll is left when speed control is given back, until a position comes.
    - `refuses`: commands that it refuses (`position`, `speed`, `mode`); one without a reply does nothing (`stick`).
    - `pitch_max`: the upper limit of pitch (deg) that it reports; an RS 5 reports 155, beyond the document's 145.
    """

    speed_signs: tuple[int, int, int] | None = None
    report_signs: tuple[int, int, int] | None = None
    legacy_replies: bool = False
    legacy_order: Order = "yaw-roll-pitch"
    push_reply_bit: bool = False
    short_push: bool = False
    ignores_speed: bool = False
    focus_motor: FocusMotorState = "calibrated"
    ignores_zero_focus: bool = False
    roll_error: float = 0.0
    pitch_max: int = 145
    bare_replies: bool = False
    silent_angles: bool = False
    reply_delay: float = 0.0
    silent_pushes: bool = False
    stick_speed: tuple[float, float, float] | None = None
    beyond_stop: BeyondStop = "stop"
    position_under_speed: PositionUnderSpeed = "obey"
    autotune_needs_type: bool = False
    refuses: tuple[Refusable, ...] = ()


DOCUMENTED = Firmware()
