"""The `inputs:` of a profile: which devices are in the hand, and what each of their controls does.

A control does one thing: it moves an axis, turns the gimbal's dial, or asks for something when pressed; a hat has four
directions that each do one. All of it is one flat section, so that an error names the key that is wrong instead of the
kinds of control it could have been; what belongs together is checked by rules on the plain data, as in `profile`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from teleop.config.base_model import Finite, Section
from teleop.config.document import DocumentError, Location, Wrong, mapping, sequence
from teleop.config.resources import find
from teleop.core.axes import STICKS, Axis
from teleop.core.operator_input import Command

PADS = "profiles/pads"  # where the shipped mappings lie
DIRECTIONS = ("up", "right", "down", "left")
FROZEN = 10.0  # s

Id = Annotated[int, Field(ge=0, le=0xFFFF)]
DeadZone = Annotated[float, Field(ge=0, le=0.3)]
Expo = Annotated[float, Field(ge=0, le=0.75)]
Amount = Annotated[float, Field(gt=0, allow_inf_nan=False)]
AxisName = Annotated[Axis, Field(strict=False)]
CommandName = Annotated[Command, Field(strict=False)]

DRONE = "drone "  # begins the words that a drone is told
_NUMBERED = frozenset({"recall", "store", "delete"})
_AXES = frozenset(axis.value for axis in Axis)


class DeviceSection(Section):
    """A device by its ids, or by its name with * for any letters; with neither, any joystick."""

    vendor: Id | None = None
    product: Id | None = None
    name: Annotated[str, Field(min_length=1)] | None = None

    @property
    def any(self) -> bool:
        return self.vendor is None and self.name is None

    def __str__(self) -> str:
        ids = (
            "" if self.vendor is None else f"{self.vendor:04x}:{'*' if self.product is None else f'{self.product:04x}'}"
        )
        return " ".join(part for part in (self.name or "", ids) if part) or "joystick"


class ActionSection(Section):
    """What a button, a direction of a hat or any other control does.

    `press` is asked for when it is pressed, `hold` instead when it is held for a second. `speed` is the most that it
    moves its axis by, as a share of full deflection.
    """

    axis: AxisName | None = None
    press: CommandName | None = None
    hold: CommandName | None = None
    number: Annotated[int, Field(ge=1, le=99)] | None = None
    words: str = ""
    invert: bool = False
    speed: Annotated[float, Field(gt=0, le=1)] = 1.0


class ControlSection(ActionSection):
    """What a control does.

    `reads` overrides what the descriptor says of it: a jog wheel that calls itself relative may send a running
    `counter`. `rest` is where it lies when nobody touches it, `range` and `centre` are in the device's own numbers.
    `coarse` and `fine` (while `fine_button` is held) are what a click is worth: in units of its axis by position, in
    deflection for one click per second by rate; of a control that is no wheel, a factor.
    """

    dial: bool = False
    by: Literal["rate", "position"] | None = None
    reads: Literal["absolute", "relative", "counter"] | None = None
    rest: Literal["low", "middle", "high"] | None = None
    dead_zone: DeadZone | None = None
    expo: Expo | None = None
    range: Annotated[list[Finite], Field(min_length=2, max_length=2)] | None = None
    centre: Finite | None = None
    coarse: Amount | None = None
    fine: Amount | None = None
    fine_button: str | None = None
    up: ActionSection | None = None
    right: ActionSection | None = None
    down: ActionSection | None = None
    left: ActionSection | None = None


Controls = dict[str, ControlSection | None]  # None: what the pad has it do is left out


class _MappedSection(Section):
    """What a profile's input and a shipped pad have in common; `frozen`: s without any change while deflected."""

    reports: Literal["auto", "continuous", "on-change"] | None = None
    frozen: Annotated[float, Field(gt=0, le=3600)] | None = None
    controls: Controls = Field(default_factory=dict)


class InputSection(_MappedSection):
    """A device in the hand. `pad` is a shipped mapping to begin with, `enable` a control to be held while moving."""

    device: DeviceSection = DeviceSection()
    name: str = ""
    pad: str | None = None
    enable: str | None = None

    @field_validator("device", mode="before", json_schema_input_type=DeviceSection | Literal["any"])
    @classmethod
    def _any(cls, value: Any) -> Any:
        return {} if value == "any" else value


class PadSection(_MappedSection):
    """A shipped mapping: the devices it is for, or why they cannot be read."""

    name: str
    devices: Annotated[list[DeviceSection], Field(min_length=1)]
    unreadable: str = ""


def input_rules(data: Any) -> Iterator[Wrong]:
    """What is wrong with a profile's `inputs` beyond its single values; `data` is the whole profile, unchecked."""
    axes = mapping(data, "axes")
    for index, section in enumerate(sequence(data, "inputs")):
        here: Location = ("inputs", index)
        device = mapping(section, "device")
        if isinstance(mapping(section).get("device"), dict) and not device.keys() & {"vendor", "product", "name"}:
            yield (*here, "device"), "must be any, or have a vendor and product, or a name"
        if "product" in device and "vendor" not in device:
            yield (*here, "device", "product"), "needs a vendor beside it"
        if isinstance(pad := mapping(section).get("pad"), str):
            yield from _pad_rules(pad, (*here, "pad"))
        yield from control_rules(mapping(section, "controls"), (*here, "controls"), axes)


def _pad_rules(pad: str, here: Location) -> Iterator[Wrong]:
    try:
        find(pad, PADS, "pad")
    except DocumentError as error:
        yield here, f"must be a mapping that exists: {error}"


def control_rules(controls: Mapping[str, Any], here: Location, axes: Mapping[str, Any] | None) -> Iterator[Wrong]:
    """`axes` are those of the rig, None where the mapping is for any rig."""
    for name, given in controls.items():
        control = mapping(given)
        place = (*here, name)
        does = [key for key in ("axis", "dial", "press") if control.get(key)]
        directions = [key for key in DIRECTIONS if control.get(key) is not None]
        if len(does) + bool(directions) > 1:
            yield place, f"can do one thing, not {' and '.join(does + directions[:1])}"
        if (
            isinstance(given, dict)
            and not does
            and not directions
            and control.keys() <= ControlSection.model_fields.keys()
        ):
            yield place, "needs an axis, a press, or dial: true; null leaves it out"
        yield from _action_rules(control, place, axes)
        for direction in directions:
            yield from _action_rules(mapping(control, direction), (*place, direction), axes)
        yield from _wheel_rules(control, place)
        yield from _stick_rules(control, place)


def _stick_rules(control: Mapping[str, Any], here: Location) -> Iterator[Wrong]:
    """A drone's stick may only be held, and is let go with the control: what stays where it was left is no stick."""
    if control.get("axis") in STICKS and (control.get("by") == "position" or control.get("rest") == "high"):
        yield here, "must be let go with the hand: a drone's stick is moved by a stick or a button, not by a slider"


def _action_rules(action: Mapping[str, Any], here: Location, axes: Mapping[str, Any] | None) -> Iterator[Wrong]:
    press, axis = action.get("press"), action.get("axis")
    asked = {word for word in (press, action.get("hold")) if isinstance(word, str)}
    if isinstance(axis, str) and axis in _AXES and axes and axis not in axes:
        yield (*here, "axis"), f"is {axis}, which this rig does not have; it has {', '.join(axes)}"
    if asked & _NUMBERED and "number" not in action:
        yield here, f"needs a number: which preset to {' or '.join(sorted(asked & _NUMBERED))}"
    if "number" in action and not asked & _NUMBERED:
        yield (*here, "number"), "is for recall, store and delete"
    words = action.get("words")
    if press == "engage" or (press == "tell" and isinstance(words, str) and words.startswith(DRONE)):
        yield here, "must be held: a drone is engaged, and told, by hold, with a press beside it (press: disengage)"
    if press == "tell" and not action.get("words"):
        yield here, "needs words to tell: gimbal follow lock"
    if "words" in action and "tell" not in asked:
        yield (*here, "words"), "are for tell"
    if "hold" in action and press is None:
        yield (*here, "hold"), "needs a press beside it, for when it is let go sooner"


def _wheel_rules(control: Mapping[str, Any], here: Location) -> Iterator[Wrong]:
    if "fine" in control and "fine_button" not in control:
        yield (*here, "fine"), "needs a fine_button"
    if "fine_button" in control and "fine" not in control:
        yield (*here, "fine_button"), "needs fine: what a click is worth meanwhile"
    ends = sequence(control, "range")
    if len(ends) == 2 and ends[0] == ends[1]:
        yield (*here, "range"), "must have two different ends"
