"""What an operator can send, by name: every command with its fields, and plain words for the common ones.

Rows only: `teleop send`, its help and its completion are made of them. A message is a value, so a plain word stands for
one whole message, and words with a choice are one row for each choice. Names are typed with spaces, `_` or `-`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING
from difflib import get_close_matches
from enum import IntEnum
from itertools import chain
from typing import Final, NamedTuple

from teleop.dji import camera, focus, gimbal
from teleop.dji.message import FieldError, Message
from teleop.dji.r_sdk import R_SDK

DEVICES: Final = ("gimbal", "camera", "focus")


def _spoken(name: str) -> str:
    return " ".join(name.lower().replace(".", " ").replace("_", " ").replace("-", " ").split())


def _rows(words: Iterable[IntEnum], prefix: str, make: type[Message], field: str) -> dict[str, Message]:
    return {
        _spoken(f"{prefix} {word.name}"): make.from_fields({field: word}) for word in words if word.name != "UNCHANGED"
    }


COMMANDS: Final[Mapping[str, type[Message]]] = {_spoken(cls.name): cls for cls in R_SDK.messages if cls.reply is False}
"""Every message that can be sent: `gimbal position`, `focus set`, ..."""

PLAIN: Final[Mapping[str, Message]] = {
    "gimbal recenter": gimbal.Mode(action=gimbal.CentreAction.RECENTER),
    "gimbal selfie": gimbal.Mode(action=gimbal.CentreAction.SELFIE),
    **_rows(gimbal.FollowMode, "gimbal follow", gimbal.Mode, "mode"),
    **_rows(gimbal.Orientation, "gimbal orientation", gimbal.Orient, "orientation"),
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
    **_rows(camera.CameraCommand, "camera", camera.Command, "command"),
    "camera status": camera.Status(),
    "focus get": focus.Get(),
    "focus calibrate": focus.Calibrate(action=focus.CalibrationAction.AUTO),
    **_rows(focus.CalibrationAction, "focus calibrate", focus.Calibrate, "action"),
}
"""Whole messages by the words for them: `gimbal follow lock`, `camera record`, ..."""


def find(words: Sequence[str]) -> Message:
    """The message that `words` ask for: `recenter`, `gimbal follow lock`, `gimbal position yaw=10 roll=0 pitch=-5`.

    The device may be left out of plain words. Ranges are not checked here. Raises FieldError.
    """
    given = [word.partition("=") for word in words if "=" in word]
    fields = {name: value for name, _, value in given}
    if len(fields) < len(given):
        raise FieldError("a field is given twice")
    name = _spoken(" ".join(word for word in words if "=" not in word))
    names = [name, *(f"{device} {name}" for device in DEVICES)]
    for full in names:
        if full in PLAIN and not fields:
            return PLAIN[full]
        if full in COMMANDS:
            return COMMANDS[full].from_fields(fields)
    if any(full in PLAIN for full in names):
        raise FieldError(f"{name} takes no fields")
    known = chain(COMMANDS, PLAIN, (full.split(" ", 1)[1] for full in chain(COMMANDS, PLAIN)))
    near = get_close_matches(name, list(known), 1)
    raise FieldError(f"there is no command {name!r}" + (f", did you mean {near[0]!r}?" if near else ""))


STREAMED: Final = (gimbal.Position, gimbal.Speed, gimbal.Joystick, gimbal.Dial, focus.Set)


def is_taken_back(message: Message) -> bool:
    """Whether it moves the gimbal or the focus motor to where the stream of a run would at once move it back from."""
    return isinstance(message, STREAMED) or (isinstance(message, gimbal.Mode) and bool(message.action))


class FieldHelp(NamedTuple):
    """One field of a command: what it must be, with its unit, and its default, None where it must be given."""

    name: str
    requirement: str
    default: str | None


def help_of(command: type[Message]) -> list[FieldHelp]:
    """The fields of `command` that an operator gives."""
    return [
        FieldHelp(name, wire.requirement(), None if default is MISSING else str(wire.to_json(default)).lower())
        for name, wire, default in command.layout.fields
        if name != "reserved"
    ]
