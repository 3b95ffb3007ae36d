"""Finds the control that was just moved, and makes the mapping: the part of `live --learn` without a device.

A question is put, and the controls are watched from where they rest: the one that moves the furthest is meant. A stick
leans on its neighbor and a trigger often has a button beside it, so that a question for an axis waits a moment for
something that can be half way before it takes a button, and a question for a button the other way round. Whether a
control springs back or stays where it was put is seen when it is let go.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, NamedTuple

from teleop.config.inputs_section import DIRECTIONS
from teleop.core.axes import Axis
from teleop.core.operator_input import Command
from teleop.inputs.hid.state import Change, Sample

FAR = 0.3  # of its range, to be meant: a stick pushed more than half way
SECOND_CHOICE = 0.5  # s until something of the other kind is taken
CLICKS = 3  # of a wheel, to be meant
MOVEMENT = 0.02  # of its range: more is a movement
RESTS = 0.25  # of its range from its middle: a stick


class Kind(Enum):
    """How a control answered."""

    STICK = "stick"  # rests in its middle
    TRIGGER = "trigger"  # rests at an end
    BUTTON = "button"
    WHEEL = "wheel"  # counts
    LEVER = "lever"  # stays where it is put


class Found(NamedTuple):
    """The control that was meant; `towards`: 1 when its value rose, -1 when it fell."""

    name: str
    kind: Kind
    towards: int


class Question(NamedTuple):
    """What is asked for: a direction of an axis, a press, or what enables."""

    text: str
    axis: Axis | None = None
    press: Command | None = None
    number: int | None = None
    enable: bool = False


_AXES: Mapping[Axis, tuple[str, str]] = {
    Axis.PAN: ("pan right", "pan left"),
    Axis.TILT: ("tilt up", "tilt down"),
    Axis.ROLL: ("roll clockwise", "roll counterclockwise"),
    Axis.FOCUS: ("focus farther", "focus nearer"),
}
_PRESSES: Sequence[tuple[str, Command, int | None]] = (
    ("STOP", Command.STOP, None),
    ("clear STOP", Command.CLEAR, None),
    ("record", Command.RECORD, None),
    ("shutter", Command.SHUTTER, None),
    ("recenter", Command.RECENTER, None),
    ("slower", Command.SLOWER, None),
    ("faster", Command.FASTER, None),
    *((f"recall preset {number} (hold: store it)", Command.RECALL, number) for number in (1, 2, 3, 4)),
)


def questions(axes: Iterable[Axis]) -> Sequence[Question]:
    """The questions for a rig that has these axes, in order."""
    asked = [
        Question(f"Move the control for: {_AXES[axis][0] if axis in _AXES else f'{axis} up'}", axis=axis)
        for axis in axes
    ]
    presses = [
        Question(f"Press the control for: {text}", press=press, number=number) for text, press, number in _PRESSES
    ]
    return [*asked, *presses, Question("Press the enable button, which must be held to move anything", enable=True)]


def other_way(question: Question) -> Question:
    """What is asked when a control moves its axis one way only."""
    axis = question.axis
    text = _AXES[axis][1] if axis is not None and axis in _AXES else f"{axis} down"
    return question._replace(text=f"Move the control for: {text}")


class Watch:
    """Controls watched from `rest` on, s on any clock; `smooth`: something that can be half way is meant."""

    def __init__(self, rest: Mapping[str, Sample], smooth: bool) -> None:
        self._rest, self._smooth = dict(rest), smooth
        self._counted: dict[str, float] = {}
        self._since = math.inf  # when something of the other kind was moved

    def see(self, values: Mapping[str, Sample], changes: Iterable[Change], now: float) -> Found | None:
        """The control that is meant, once that is clear."""
        for change in changes:
            if change.sample.relative:
                self._counted[change.name] = self._counted.get(change.name, 0.0) + change.sample.value
        moved = {name: self._moved(name, sample) for name, sample in values.items() if not _is_hat(name, values)}
        smooth = {name: far for name, far in moved.items() if not _is_button(values[name])}
        abrupt = {name: far for name, far in moved.items() if name not in smooth}
        first, second = (smooth, abrupt) if self._smooth else (abrupt, smooth)
        if found := _furthest(first):
            return self._found(found, first[found], values)
        if found := _furthest(second):
            self._since = min(self._since, now)
            if now - self._since >= SECOND_CHOICE:
                return self._found(found, second[found], values)
        return None

    def settled(self, found: Found, values: Mapping[str, Sample]) -> Found:
        """The same, looked at again after it was let go: what has not gone back is a lever."""
        springs = found.kind in (Kind.BUTTON, Kind.WHEEL) or abs(self._moved(found.name, values[found.name])) < FAR
        return found if springs else found._replace(kind=Kind.LEVER)

    def _moved(self, name: str, sample: Sample) -> float:
        """How far it is from its rest, as a share of its range, a wheel by its clicks; 1 is far."""
        if sample.relative:
            return self._counted.get(name, 0.0) * FAR / CLICKS
        rest = self._rest.setdefault(name, sample._replace(value=0) if _is_button(sample) else sample)
        span = sample.maximum - sample.minimum
        return 0.0 if sample.null or rest.null or span <= 0 else (sample.value - rest.value) / span

    def _found(self, name: str, far: float, values: Mapping[str, Sample]) -> Found:
        sample = values[name]
        if sample.relative:
            kind = Kind.WHEEL
        elif _is_button(sample):
            kind = Kind.BUTTON
        else:
            middle = (sample.minimum + sample.maximum) / 2
            near = abs(self._rest[name].value - middle) <= RESTS * (sample.maximum - sample.minimum)
            kind = Kind.STICK if near else Kind.TRIGGER
        return Found(name, kind, 1 if far > 0 else -1)


def still(before: Mapping[str, Sample], after: Mapping[str, Sample]) -> bool:
    """Whether nothing has moved between two looks, and no button is held."""
    return not any(_restless(name, sample, before, after) for name, sample in after.items())


def _restless(name: str, sample: Sample, before: Mapping[str, Sample], after: Mapping[str, Sample]) -> bool:
    if sample.relative or _is_hat(name, after):
        return False
    moved = abs(sample.value - before.get(name, sample).value)
    return sample.pressed if _is_button(sample) else moved > MOVEMENT * abs(sample.maximum - sample.minimum)


@dataclass
class Learned:
    """The mapping so far, in a profile's words."""

    controls: dict[str, dict[str, Any]] = field(default_factory=dict)
    enable: str = ""

    def has(self, name: str) -> bool:
        return name in self.controls or name == self.enable

    def add(self, question: Question, found: Found, back: bool = False) -> None:
        """`found` answers `question`; `back`: it moves the axis the other way."""
        if question.enable:
            self.enable = found.name
        elif question.press is not None:
            hold = {"hold": Command.STORE.value} if question.press is Command.RECALL else {}
            number = {} if question.number is None else {"number": question.number}
            self.controls[found.name] = {"press": question.press.value, **number, **hold}
        elif question.axis is not None:
            self.controls[found.name] = {"axis": question.axis.value, **_moves(found, back)}

    def nested(self) -> Mapping[str, Mapping[str, Any]]:
        """The controls as a profile has them: the directions of a hat below it."""
        nested: dict[str, dict[str, Any]] = {}
        for name, does in self.controls.items():
            hat, direction = _direction(name)
            if direction:
                nested.setdefault(hat, {})[direction] = does
            else:
                nested[name] = does
        return nested

    def text(self, vendor: int, product: int, title: str) -> str:
        """The `inputs:` of a profile, for the device with these ids."""
        lines = [f"inputs:   # {title}", f"  - device: {{vendor: {vendor:#06x}, product: {product:#06x}}}"]
        lines += [f"    enable: {_key(self.enable)}"] if self.enable else []
        lines += ["    controls:"] if self.controls else ["    controls: {}"]
        for name, does in self.nested().items():
            key = _key(name)
            if name in self.controls:
                lines.append(f"      {key}: {_flow(does)}")
            else:
                lines += [f"      {key}:", *(f"        {way}: {_flow(action)}" for way, action in does.items())]
        return "\n".join(lines) + "\n"


def _moves(found: Found, back: bool) -> Mapping[str, Any]:
    towards = -found.towards if back else found.towards
    if found.kind is Kind.TRIGGER:  # it moves away from its end, whichever that is
        rest = {"rest": "low" if found.towards > 0 else "high"}
        return {**rest, "invert": True} if back else rest
    by = {"by": "position"} if found.kind in (Kind.LEVER, Kind.WHEEL) else {}
    return {**by, "invert": True} if towards < 0 else by


def _furthest(moved: Mapping[str, float]) -> str | None:
    name = max(moved, key=lambda name: abs(moved[name]), default=None)
    return name if name is not None and abs(moved[name]) >= FAR else None


def _is_button(sample: Sample) -> bool:
    return not sample.relative and sample.maximum - sample.minimum == 1


def _is_hat(name: str, values: Mapping[str, Sample]) -> bool:
    """A hat is watched by its directions."""
    return f"{name} {DIRECTIONS[0]}" in values


def _direction(name: str) -> tuple[str, str]:
    """`Hat switch up` as the hat and its direction; of anything else no direction."""
    hat, _, last = name.rpartition(" ")
    return (hat, last) if hat.startswith("Hat") and last in DIRECTIONS else (name, "")


def _key(name: str) -> str:
    return f'"{name}"' if "#" in name else name  # one of a British keyboard, and no comment


def _flow(does: Mapping[str, Any]) -> str:
    return "{" + ", ".join(f"{key}: {'true' if value is True else value}" for key, value in does.items()) + "}"
