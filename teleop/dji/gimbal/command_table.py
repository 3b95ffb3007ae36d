"""What an operator can send to a gimbal, its camera and its focus motor, by name. Rows only: see vocabulary.py."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from teleop.dji.command_parser import Vocabulary, commands, rows
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import Message

COMMANDS: Final[Mapping[str, type[Message]]] = commands(R_SDK.messages)
"""Every message that can be sent: `gimbal position`, `focus set`, ..."""

PLAIN: Final[Mapping[str, Message]] = {
    "gimbal recenter": gimbal.Mode(action=gimbal.CenterAction.RECENTER),
    "gimbal selfie": gimbal.Mode(action=gimbal.CenterAction.SELFIE),
    **rows(gimbal.FollowMode, "gimbal follow", gimbal.Mode, "mode"),
    "gimbal follow pan": gimbal.Mode(gimbal.FollowMode.YAW),  # the word of the button, and of sequences
    **rows(gimbal.Orientation, "gimbal orientation", gimbal.Orient, "orientation"),
    "gimbal angles": gimbal.Angles(),
    "gimbal angles joint": gimbal.Angles(gimbal.AngleKind.JOINT),
    "gimbal limits": gimbal.Limits(),
    "gimbal stiffness": gimbal.Stiffness(),
    "gimbal version": gimbal.Version(),
    "gimbal push on": gimbal.PushSettings(gimbal.Switch.ON),
    "gimbal push off": gimbal.PushSettings(gimbal.Switch.OFF),
    "gimbal calibrate": gimbal.Calibrate(start=True),
    "gimbal calibrate stop": gimbal.Calibrate(start=False),
    "gimbal track": gimbal.ActiveTrack(),
    **rows(camera.CameraCommand, "camera", camera.Command, "command"),
    "camera status": camera.Status(),
    "focus get": focus.Get(),
    "focus calibrate": focus.Calibrate(action=focus.CalibrationAction.AUTO),
    **rows(focus.CalibrationAction, "focus calibrate", focus.Calibrate, "action"),
}
"""Whole messages by the words for them: `gimbal follow lock`, `camera record`, ..."""

RIG: Final = Vocabulary(("gimbal", "camera", "focus"), COMMANDS, PLAIN)
find = RIG.find

STREAMED: Final = (gimbal.Position, gimbal.Speed, gimbal.Joystick, gimbal.Dial, focus.Set)


def is_taken_back(message: Message) -> bool:
    """Whether it moves the gimbal or the focus motor to where the stream of a run would at once move it back from."""
    return isinstance(message, STREAMED) or (isinstance(message, gimbal.Mode) and bool(message.action))
