"""What an operator can send to the drone, by name, and what of it can make it fly. Rows only: see vocabulary.py.

A command from a shell is sent once, with no operator at the controls after it. So whatever moves the drone, starts its
motors or takes it from its pilot is a hazard, which an operator has to say that they understand; and what is safe only
with a stream behind it is never sent so (docs/protocol-facts.md). What the drone itself sends has no words.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from teleop.dji.command_parser import Vocabulary, commands, rows
from teleop.dji.drone import messages as drone
from teleop.dji.drone import movement, virtual_rc
from teleop.dji.drone.enums import ArmOrder, ControlOrder, TaskKind
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.message import Message

COMMANDS: Final[Mapping[str, type[Message]]] = {
    name: cls
    for name, cls in commands(sorted(M100.messages, key=lambda cls: cls.set_and_id)).items()
    if cls.set_and_id[0] != drone.PUSH and cls is not drone.Activate
}
"""Every message that a computer can send to a drone, but for the one with a secret in it: `drone version`, ..."""

PLAIN: Final[Mapping[str, Message]] = {
    **rows(TaskKind, "drone", drone.Task, "task"),
    **rows(ArmOrder, "drone", drone.Arm, "order"),
    "drone activate": drone.Activate(0),  # the app id comes from the credentials
    "drone obtain control": drone.Control(ControlOrder.OBTAIN),
    "drone release control": drone.Control(ControlOrder.RELEASE),
    "drone virtual rc off": virtual_rc.VirtualRc(on=False),
}
"""Whole messages by the words for them: `drone take off`, `drone arm`, ..."""

DRONE: Final = Vocabulary(("drone",), COMMANDS, PLAIN, {virtual_rc.Sticks})


def never(message: Message) -> str:
    """Why `message` must not be sent from a shell at all; nothing when it may."""
    if isinstance(message, virtual_rc.VirtualRc) and message.on:
        return "virtual RC without a stream of sticks gives the drone up after a second"
    if isinstance(message, virtual_rc.Sticks):
        return "sticks fly on for 1 s without an operator: only a run's control loop sends them"
    return ""


def hazard(message: Message) -> str:
    """What `message` can do to people near it; "" for what cannot make the drone fly."""
    match message:
        case drone.Arm(order=ArmOrder.ARM):
            return "it starts the motors"
        case drone.Arm():
            return "it stops the motors"
        case drone.Task() | movement.Move():
            return "the drone flies without an operator"
        case drone.Control(order=ControlOrder.OBTAIN):
            return "it takes the drone from its pilot"
        case virtual_rc.VirtualRc():
            return "it takes the drone from whatever flies it by virtual RC"
    return ""
