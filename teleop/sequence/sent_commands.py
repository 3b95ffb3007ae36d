"""Cues that send a command in the words of `teleop send`: which may stand in a sequence, and what they move.

Apart from the other cues because it loads the protocol, which a sequence without such cues needs no part of.
"""

from __future__ import annotations

from teleop.core.events import Action
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.command_table import find, is_taken_back
from teleop.dji.message import FieldError, Message

_BY_ITSELF = (gimbal.Calibrate, gimbal.ActiveTrack, gimbal.Orient)
_CAMERA = {
    camera.CameraCommand.RECORD: Action.RECORD,
    camera.CameraCommand.STOP: Action.STOP,
    camera.CameraCommand.SHUTTER: Action.SHUTTER,
    camera.CameraCommand.CENTER_FOCUS: Action.FOCUS,
    camera.CameraCommand.END_CENTER_FOCUS: Action.END_FOCUS,
}


def is_for_camera(words: str) -> bool:
    """Whether it is a command that nothing need rest for."""
    return find(words.split()).name.startswith("camera.")


def moves_by_itself(words: str) -> str:
    """The device that moves of its own accord after it, nothing where none does."""
    message = find(words.split())
    if isinstance(message, _BY_ITSELF):
        return "gimbal"
    return "focus motor" if isinstance(message, focus.Calibrate) else ""


def unsendable(words: str) -> str:
    """Why it may not be sent in a sequence, nothing where it may."""
    try:
        message = find(words.split())
        message.check()
    except FieldError as error:
        return f": {error}"
    if isinstance(message, camera.Command | camera.ShortCommand) and message.command in _CAMERA:
        return f"must be written as camera: {_CAMERA[camera.CameraCommand(message.command)].value}"
    if is_taken_back(message):
        return f"conflicts with the motion of the run: {_instead(message)}"
    return ""


def _instead(message: Message) -> str:
    match message:
        case gimbal.Mode(action=gimbal.CenterAction.RECENTER):
            return "write recenter: 3s"
        case gimbal.Dial():
            return "a dial is for teleop live"
        case focus.Set():
            return "write focus: into a keyframe"
        case _:
            return "write pan:, tilt: and roll: into a keyframe"
