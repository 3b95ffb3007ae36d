"""Cues: what happens once at a time of a sequence, beside the motion: camera, the gimbal's own commands, a wait.

A command is looked up, and its ranges are checked, when the file is read. What the gimbal does by itself would be taken
back by the stream that moves it, so that is refused with what does it instead: a recenter is planned like any other
way to a key. What changes how the gimbal behaves is given only where every axis rests, as in `teleop live`.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple

from pydantic import ConfigDict

from teleop.config.device_commands import parse_command
from teleop.config.documents.base_model import Section
from teleop.config.documents.document import Location, Wrong, mapping
from teleop.config.documents.json_types import Time
from teleop.core.axes import Axis
from teleop.core.events import Action, DeviceCommand, TickEvent
from teleop.core.timing import SAME_TIME

LASTING = ((Action.RECORD, Action.STOP), (Action.FOCUS, Action.END_FOCUS))  # what begins it, and ends it
KINDS = ("camera", "follow", "recenter", "send", "wait")
FOLLOW: Mapping[str, DeviceCommand] = {
    "lock": DeviceCommand("gimbal", "follow lock"),
    "pan": DeviceCommand("gimbal", "follow yaw"),
    "yaw": DeviceCommand("gimbal", "follow yaw"),  # the gimbal's own word for it, and that of `teleop send`
    "sport": DeviceCommand("gimbal", "follow sport"),
}
CENTERED = (Axis.PAN, Axis.TILT, Axis.ROLL)
"""What a recenter takes to 0, and what moves when the gimbal does something by itself."""


class CueSection(Section):
    """Something that happens once; exactly one action."""

    model_config = ConfigDict(json_schema_extra={"oneOf": [{"required": [kind]} for kind in KINDS]})

    at: Time
    """Time from the start: `4`, `4s`, `1m30s`; with `fps` also `96f` and `00:00:04:00`."""
    camera: Literal["record", "stop", "shutter", "focus", "end_focus"] | None = None
    """Camera command; a focus on the center holds until end_focus."""
    follow: Literal["lock", "pan", "yaw", "sport"] | None = None
    """Follow mode of the gimbal: what turning its handle moves."""
    recenter: Time = None
    """Pan, tilt and roll go to 0 within this time: `3s`."""
    send: str | None = None
    """A command in the words of `teleop send`."""
    wait: Literal["operator"] | None = None
    """Hold everything until the operator continues."""

    @property
    def kind(self) -> str:
        """Which of KINDS it is."""
        return next(kind for kind in KINDS if getattr(self, kind) is not None)

    @property
    def act(self) -> TickEvent | Wait | None:
        """What is done; None where that is motion."""
        if self.camera:
            return Action(self.camera)
        if self.follow:
            return FOLLOW[self.follow]
        if self.send:
            return parse_command(self.send)
        return Wait() if self.wait else None

    @property
    def needs_rest(self) -> bool:
        """Whether it may be only where every axis rests; a command for the camera may be anywhere."""
        if self.send is None:
            return bool(self.follow or self.wait)
        from teleop.sequence.sent_commands import is_for_camera

        return not is_for_camera(self.send)


class Wait(NamedTuple):
    """The move holds until the operator says go."""


class Cue(NamedTuple):
    """An action `at` so many seconds after the first keyframe's zero."""

    at: float
    action: TickEvent | Wait

    @property
    def name(self) -> str:
        """For people, in a word or a few."""
        match self.action:
            case DeviceCommand():
                return str(self.action)
            case Wait():
                return "wait"
            case _:
                return str(getattr(self.action, "value", self.action))


def cues_from(cues: Sequence[Cue], start_at: float) -> tuple[list[TickEvent], list[Cue]]:
    """What to do in place, and in a pass that begins at `start_at` (s), in mid move.

    What came before is not made up for, but for what would be going on by then: the camera records, or focuses, as the
    run-up begins, and the gimbal has its follow mode.
    """
    before = [cue.action for cue in cues if cue.at < start_at - SAME_TIME]
    follows = [
        act
        for act in before
        if isinstance(act, DeviceCommand) and act.device == "gimbal" and act.name.startswith("follow")
    ]
    going_on = []
    for on, off in LASTING:
        switches = [act for act in before if act in (on, off)]
        going_on += [Cue(-math.inf, on)] if switches[-1:] == [on] else []
    return [*follows[-1:]], [*going_on, *cues[len(before) :]]


def cue_rules(cue: Any, here: Location) -> Iterator[Wrong]:
    """What is wrong with one cue, whatever moves beside it, but for its times."""
    given = [kind for kind in KINDS if mapping(cue).get(kind) is not None]
    if isinstance(cue, dict) and len(given) != 1 and cue.keys() <= {"at", *KINDS}:
        yield here, f"must have one of {', '.join(KINDS)}{', not ' + ' and '.join(given) if given else ''}"
    words = mapping(cue).get("send")
    if isinstance(words, str):
        from teleop.sequence.sent_commands import unsendable

        if wrong := unsendable(words):
            yield (*here, "send"), wrong


def moved_rules(cue: Any, here: Location, moved: Collection[str]) -> Iterator[Wrong]:
    """What is wrong with one cue, which has passed `cue_rules`, in a sequence that moves the axes `moved`."""
    turns = any(axis in moved for axis in CENTERED)
    if mapping(cue).get("recenter") is not None and not turns:
        yield (*here, "recenter"), "needs a keyframe with pan, tilt or roll"
    words = mapping(cue).get("send")
    if words:
        from teleop.sequence.sent_commands import moves_by_itself

        device = moves_by_itself(words)
        if (device == "gimbal" and turns) or (device == "focus motor" and Axis.FOCUS in moved):
            yield (*here, "send"), f"moves the {device} by itself, against the keyframes"
