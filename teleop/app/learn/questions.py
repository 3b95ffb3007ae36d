"""What `live --learn` asks for: each axis of the rig, each command, the enable button."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from teleop.core.axes import Axis
from teleop.core.operator_input import Command

PRESETS = (1, 2, 3, 4)


class Question(NamedTuple):
    """What a control is asked for: `axis` or `dial`, a `press` with its `number` or `command`, or `enable`.

    `text` has no end: the screen says how to skip it. `back` is the text for the other direction of an axis.
    """

    text: str
    axis: Axis | None = None
    dial: bool = False
    press: Command | None = None
    hold: Command | None = None
    number: int | None = None
    command: str = ""
    enable: bool = False
    back: str = ""

    @property
    def moves(self) -> bool:
        """Whether something that can be half way is meant."""
        return self.axis is not None or self.dial

    def is_answered_by(self, action: Mapping[str, Any]) -> bool:
        """Whether a control of a profile that does this does what is asked for."""
        if self.axis is not None:
            return action.get("axis") == self.axis.value
        if self.dial:
            return bool(action.get("dial"))
        numbered = self.number is None or action.get("number") == self.number
        same = numbered and action.get("command", "") == self.command
        return self.press is not None and action.get("press") == self.press.value and same


_AXES: Mapping[Axis, tuple[str, str]] = {
    Axis.PAN: ("pan right", "pan left"),
    Axis.TILT: ("tilt up", "tilt down"),
    Axis.ROLL: ("roll clockwise", "roll counterclockwise"),
    Axis.FOCUS: ("focus farther", "focus nearer"),
    Axis.STICK_ROLL: ("drone right", "drone left"),
    Axis.STICK_PITCH: ("drone forward", "drone backward"),
    Axis.STICK_THROTTLE: ("drone up", "drone down"),
    Axis.STICK_YAW: ("drone turn clockwise", "drone turn counterclockwise"),
}
_FIRST: Sequence[tuple[str, Command]] = (
    ("STOP", Command.STOP),
    ("CLEAR STOP", Command.CLEAR),
    ("RECORD", Command.RECORD),
    ("SHUTTER", Command.SHUTTER),
    ("RECENTER", Command.RECENTER),
    ("SLOWER", Command.SLOWER),
    ("FASTER", Command.FASTER),
    ("NEXT SPEED RANGE", Command.RANGE),
)
_RUNS: Sequence[tuple[str, Command]] = (
    ("PAUSE", Command.PAUSE),
    ("GO", Command.GO),
    ("NEXT KEYFRAME", Command.NEXT),
    ("PREVIOUS KEYFRAME", Command.PREVIOUS),
    ("KEEP THE TRIM", Command.KEEP),
    ("QUIT", Command.QUIT),
)
_TOLD = "gimbal follow lock"  # a device's own command, to have its words changed in the file


def questions(axes: Iterable[Axis], dial: bool = False, drone: bool = False) -> Sequence[Question]:
    """The questions for a rig with these axes, in order; `dial`: of a gimbal, which has one; `drone`: with a drone."""
    asked = [_axis(axis) for axis in axes]
    if dial:
        asked.append(Question("Turn the control for DIAL UP", dial=True, back="Turn the control for DIAL DOWN"))
    asked.append(Question("Press the button that ENABLES motion while it is held", enable=True))
    asked += [_press(text, command) for text, command in _FIRST]
    asked += [
        _press(f"RECALL PRESET {number} (held: store it)", Command.RECALL, Command.STORE, number) for number in PRESETS
    ]
    if drone:
        asked.append(_press("DISENGAGE THE DRONE (held: engage it)", Command.DISENGAGE, Command.ENGAGE))
    asked += [_press(text, command) for text, command in _RUNS]
    asked += [_press(f"DELETE PRESET {number}", Command.DELETE, number=number) for number in PRESETS]
    if dial:
        asked.append(_press(f"TELL {_TOLD}", Command.TELL)._replace(command=_TOLD))
    return asked


def _axis(axis: Axis) -> Question:
    forward, back = (f"Move the control for {words.upper()}" for words in _AXES[axis])
    return Question(forward, axis=axis, back=back)


def _press(text: str, command: Command, hold: Command | None = None, number: int | None = None) -> Question:
    return Question(f"Press the control for {text}", press=command, hold=hold, number=number)
