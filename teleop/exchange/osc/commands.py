"""What an OSC message asks for, as a command of the door. Pure: it knows no socket, no clock and no rig but its axes.

A button sends 1 when it is pressed and 0 when it is let go: a last argument of 0 does nothing, except in a STOP.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from typing import Any

from teleop.config.exchange.presses import PRESSES
from teleop.core.axes import Axis
from teleop.links.osc_packets import Argument, Message

ROOT = "/teleop/"
STOP = {"do": "stop"}
QUIET = ("alive", "state")
"""Messages that ask for nothing of the rig."""
ATTENDED, UNATTENDED = "attended", "unattended"
"""Whether a move goes on only while its sender is heard. A button sends one message: without a word it goes on."""
GOTO = (Axis.PAN, Axis.TILT, Axis.ROLL)

Command = Mapping[str, Any]
Arguments = tuple[Argument, ...]


class Invalid(ValueError):  # noqa: N818 - an answer, no error of the program
    """Why a message of ours cannot be obeyed."""


def command(message: Message, axes: Collection[Axis]) -> Command | None:
    """The command that a message is; None for one that does nothing. Raises Invalid for one that asks for what is none.

    Messages that are not under `/teleop/` are other people's. `axes` are the rig's.
    """
    if not message.address.startswith(ROOT):
        return None
    name, *parts = message.address.removeprefix(ROOT).rstrip("/").split("/")
    if name == "stop" and not parts:
        return STOP
    if (name in QUIET and not parts) or _released(name, message.arguments):
        return None
    if name in PRESSES and not parts:  # `/teleop/record` and so on
        return {"do": name}
    if (make := MAKERS.get(name)) is None:
        raise Invalid(f"{message.address[:60]}: there is no such message")
    return make(parts, message.arguments, axes)


def _released(name: str, arguments: Arguments) -> bool:
    """Whether a button was let go. The numbers of a goto, a jog or a speed are no button's."""
    if name in ("goto", "speed"):
        return False
    pressed = arguments[0] if name == "jog" and arguments else arguments[-1] if arguments else 1
    return isinstance(pressed, int | float) and not pressed


def _goto(parts: list[str], arguments: Arguments, axes: Collection[Axis]) -> Command:
    """`/teleop/goto pan tilt roll [seconds]`, or `/teleop/goto/AXIS position [seconds]`."""
    numbers = _numbers("goto", arguments)
    if parts:
        axis = _axis("goto", parts)
        if not 1 <= len(numbers) <= 2:
            raise Invalid(f"goto/{axis}: needs a position and, if you like, seconds")
        return {"do": "goto", "axes": {axis.value: numbers[0]}, **_timed("seconds", numbers[1:])}
    if not 3 <= len(numbers) <= 4:
        raise Invalid("goto: needs pan, tilt, roll and, if you like, seconds")
    asked = zip(GOTO, numbers, strict=False)
    targets = {axis.value: to for axis, to in asked if axis in axes or to}  # a rig without roll has 0 of it
    return {"do": "goto", "axes": targets, **_timed("seconds", numbers[3:])}


def _jog(parts: list[str], arguments: Arguments, axes: Collection[Axis]) -> Command:  # noqa: ARG001 - the door checks
    axis, numbers = _axis("jog", parts), _numbers("jog", arguments)
    if not 1 <= len(numbers) <= 2:
        raise Invalid(f"jog/{axis}: needs by how much and, if you like, within how many seconds")
    return {"do": "jog", "axis": axis.value, "by": numbers[0], **_timed("within", numbers[1:])}


def _preset(parts: list[str], arguments: Arguments, axes: Collection[Axis]) -> Command:  # noqa: ARG001
    number, *rest = parts or [""]
    if not (number.isascii() and number.isdigit() and len(number) < 4) or rest not in ([], ["store"]):
        raise Invalid("preset: needs a number, as in /teleop/preset/1 or /teleop/preset/1/store")
    return {"do": "preset_store" if rest else "preset_recall", "number": int(number)}


def _play(parts: list[str], arguments: Arguments, axes: Collection[Axis]) -> Command:  # noqa: ARG001
    words = [*parts, *(each for each in arguments if isinstance(each, str))]
    if not 1 <= len(words) <= 2 or words[1:] not in ([], [ATTENDED], [UNATTENDED]):
        raise Invalid('play: needs the name of a move, as in /teleop/play "reveal"; "attended" may follow')
    return {"do": "play", "move": words[0], "attended": words[1:] == [ATTENDED]}


def _speed(parts: list[str], arguments: Arguments, axes: Collection[Axis]) -> Command:  # noqa: ARG001
    numbers = _numbers("speed", arguments)
    if parts or len(numbers) != 1:
        raise Invalid("speed: needs a share of the speed, as in /teleop/speed 0.5")
    return {"do": "speed", "share": numbers[0]}


def _track(parts: list[str], arguments: Arguments, axes: Collection[Axis]) -> Command:  # noqa: ARG001
    """`/teleop/track`, or `/teleop/track/N`, with the text `attended` where it ends in silence."""
    if len(parts) > 1 or (parts and not (parts[0].isascii() and parts[0].isdigit() and len(parts[0]) < 3)):
        raise Invalid("track: needs the number of a tracking source, as in /teleop/track/1")
    source = {"source": int(parts[0])} if parts else {}
    return {"do": "track", **source, "attended": ATTENDED in arguments}


MAKERS: Mapping[str, Callable[[list[str], Arguments, Collection[Axis]], Command]] = {
    "goto": _goto,
    "track": _track,
    "jog": _jog,
    "preset": _preset,
    "play": _play,
    "speed": _speed,
}


def _axis(name: str, parts: list[str]) -> Axis:
    try:
        (word,) = parts
        return Axis(word)
    except ValueError:
        raise Invalid(f"{name}: needs an axis, as in /teleop/{name}/pan") from None


def _numbers(name: str, arguments: Arguments) -> list[float]:
    """Whole numbers and doubles do as well."""
    for each in arguments:
        if isinstance(each, bool) or not isinstance(each, int | float) or not math.isfinite(each):
            raise Invalid(f"{name}: needs numbers")
    return [float(each) for each in arguments if isinstance(each, int | float)]


def _timed(name: str, numbers: list[float]) -> Command:
    """0 seconds are as soon as the limits allow."""
    if numbers and numbers[0] < 0:
        raise Invalid(f"{name} must not be less than 0")
    return {name: numbers[0]} if numbers and numbers[0] else {}
