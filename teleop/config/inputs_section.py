"""The `inputs:` of a profile: which devices are in the hand, and what each of their controls does.

A control does one thing: it moves an axis, turns the gimbal's dial, or asks for something when pressed; a hat has four
directions that each do one. All of it is one flat section, so that an error names the key that is wrong instead of the
kinds of control it could have been; what belongs together is checked by rules on the plain data, as in `profile`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, field_validator

from teleop.config.device_commands import DRONE, parse_command
from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.document import DocumentError, Location, Wrong, mapping, sequence
from teleop.config.resources import find
from teleop.core.axes import STICKS, Axis
from teleop.core.errors import TeleopError
from teleop.core.operator_input import Command

PADS = "profiles/pads"  # where the shipped mappings lie
DIRECTIONS = ("up", "right", "down", "left")
STUCK_TIMEOUT = 10.0  # s

Id = Annotated[int, Field(ge=0, le=0xFFFF)]
DeadZone = Annotated[float, Field(ge=0, le=0.3)]
Expo = Annotated[float, Field(ge=0, le=0.75)]
Amount = Annotated[float, Field(gt=0, allow_inf_nan=False)]
AxisName = Annotated[Axis, Field(strict=False)]
CommandName = Annotated[Command, Field(strict=False)]

_NUMBERED = frozenset({"recall", "store", "delete"})
_AXES = frozenset(axis.value for axis in Axis)


class DeviceSection(Section):
    """A device by its ids, name, serial number or port; without any of these, any joystick."""

    vendor: Id | None = None
    """USB vendor id, 0 to 0xFFFF."""
    product: Id | None = None
    """USB product id, 0 to 0xFFFF; any product of the vendor without it."""
    name: Annotated[str, Field(min_length=1)] | None = None
    """Name of the device; * matches any letters."""
    serial: Annotated[str, Field(min_length=1)] | None = None
    """Serial number, for one of several devices of a model."""
    port: Annotated[str, Field(min_length=1)] | None = None
    """USB port as `teleop devices` shows it (1-2.3), for one of several devices without a serial number."""
    interface: Annotated[int, Field(ge=0, le=255)] | None = None
    """USB interface, where a device has several."""

    @property
    def any(self) -> bool:
        return not any(self.exactness)

    @property
    def exactness(self) -> tuple[int, int]:
        """How exactly it names a device, to compare: a serial number or a port is more than any ids."""
        units, models = (self.serial, self.port), (self.vendor, self.product, self.name, self.interface)
        return sum(key is not None for key in units), sum(key is not None for key in models)

    def __str__(self) -> str:
        ids = (
            "" if self.vendor is None else f"{self.vendor:04x}:{'*' if self.product is None else f'{self.product:04x}'}"
        )
        serial = f"serial {self.serial}" if self.serial else ""
        port = f"port {self.port}" if self.port else ""
        interface = "" if self.interface is None else f"interface {self.interface}"
        return " ".join(part for part in (self.name or "", ids, serial, port, interface) if part) or "joystick"


class ActionSection(Section):
    """What a button, a direction of a hat or another control does."""

    RENAMED: ClassVar = {"words": "command"}

    axis: AxisName | None = None
    """The axis that it moves."""
    press: CommandName | None = None
    """What a press does."""
    hold: CommandName | None = None
    """What a press of one second does instead of `press`."""
    number: Annotated[int, Field(ge=1, le=99)] | None = None
    """Number of the preset, for recall, store and delete."""
    command: str = ""
    """Command in the words of `teleop send`, for tell: `gimbal follow lock`."""
    invert: bool = False
    """Turn the direction round."""
    speed: Annotated[float, Field(gt=0, le=1)] = 1.0
    """Largest deflection, as a share of full deflection."""


class ControlSection(ActionSection):
    """What a control does."""

    RENAMED: ClassVar = {**ActionSection.RENAMED, "reads": "value_type", "centre": "center"}

    dial: bool = False
    """Whether it turns the gimbal's own dial."""
    by: Literal["rate", "position"] | None = None
    """Whether it sets a rate or a position of its axis."""
    value_type: Literal["absolute", "relative", "counter"] | None = None
    """What its values are, where the device describes them wrongly: a jog wheel may send a counter."""
    rest: Literal["low", "middle", "high"] | None = None
    """Where it lies when it is released."""
    dead_zone: DeadZone | None = None
    """As `dead_zone` of `sticks`, for this control."""
    expo: Expo | None = None
    """As `expo` of `sticks`, for this control."""
    range: Annotated[list[Finite], Field(min_length=2, max_length=2)] | None = None
    """Its lowest and highest value, in the device's own numbers."""
    center: Finite | None = None
    """Its value at rest, in the device's own numbers."""
    coarse: Amount | None = None
    """One click in units of its axis (by position) or deflection per click/s (by rate); else a factor."""
    fine: Amount | None = None
    """As `coarse`, while `fine_button` is held."""
    fine_button: str | None = None
    """Name of the button for `fine`."""
    up: ActionSection | None = None
    """What the hat does upward."""
    right: ActionSection | None = None
    """What the hat does to the right."""
    down: ActionSection | None = None
    """What the hat does downward."""
    left: ActionSection | None = None
    """What the hat does to the left."""


Controls = dict[str, ControlSection | None]  # None: what the pad has it do is left out


class _MappedSection(Section):
    """The keys that a profile's input and a shipped pad share."""

    RENAMED: ClassVar = {"frozen": "stuck_timeout"}

    reports: Literal["auto", "continuous", "on-change"] | None = None
    """When the device sends reports: continuously, on change, or found out by itself."""
    stuck_timeout: Annotated[float, Field(gt=0, le=3600)] | None = None
    """Time in s without any change while deflected, after which the device counts as stuck."""
    controls: Controls = Field(default_factory=dict)
    """What each control does, by its name; null leaves one out that the pad has."""


class InputSection(_MappedSection):
    """A joystick, pad or dial."""

    device: DeviceSection = DeviceSection()
    """The device by its ids or name; `any` for any joystick."""
    name: str = ""
    """Name of the input on screens."""
    pad: str | None = None
    """Shipped mapping or file to start from; `controls` changes it."""
    enable: str | None = None
    """Button that must be held for the device to move anything."""

    @field_validator("device", mode="before", json_schema_input_type=DeviceSection | Literal["any"])
    @classmethod
    def _any(cls, value: Any) -> Any:
        return {} if value == "any" else value


class PadDeviceSection(DeviceSection):
    """A device that a shipped mapping is for."""

    driver: str | None = None
    """Linux driver that names its controls, read by its event device: xpad; without it the device's own names."""


class PadSection(_MappedSection):
    """A shipped mapping: the devices it is for, or why they cannot be read."""

    name: str
    """Name of the pad."""
    devices: Annotated[list[PadDeviceSection], Field(min_length=1)]
    """The devices that the mapping is for."""
    unreadable: str = ""
    """Why the reports of these devices cannot be read; empty where they can."""


def input_rules(data: Any) -> Iterator[Wrong]:
    """What is wrong with a profile's `inputs` beyond its single values; `data` is the whole profile, unchecked."""
    axes = mapping(data, "axes")
    for index, section in enumerate(sequence(data, "inputs")):
        here: Location = ("inputs", index)
        device = mapping(section, "device")
        if isinstance(mapping(section).get("device"), dict) and not device.keys() & DeviceSection.model_fields.keys():
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
        yield here, "must return to its center when released: use a stick or a button for a drone, not a slider"


def _action_rules(action: Mapping[str, Any], here: Location, axes: Mapping[str, Any] | None) -> Iterator[Wrong]:
    press, axis = action.get("press"), action.get("axis")
    asked = {word for word in (press, action.get("hold")) if isinstance(word, str)}
    if isinstance(axis, str) and axis in _AXES and axes and axis not in axes:
        yield (*here, "axis"), f"is {axis}, which this rig does not have; it has {', '.join(axes)}"
    if asked & _NUMBERED and "number" not in action:
        yield here, f"needs a number: which preset to {' or '.join(sorted(asked & _NUMBERED))}"
    if "number" in action and not asked & _NUMBERED:
        yield (*here, "number"), "is for recall, store and delete"
    command = action.get("command")
    to_drone = isinstance(command, str) and command.split()[:1] == [DRONE]
    if press == "engage" or (press == "tell" and to_drone):
        yield (
            here,
            "must be held: use `hold` to engage a drone or command it, with a `press` beside it (press: disengage)",
        )
    if press == "tell" and not action.get("command"):
        yield here, "needs a command: gimbal follow lock"
    if "command" in action and "tell" not in asked:
        yield (*here, "command"), "is for tell"
    elif isinstance(command, str) and command and (wrong := _command_error(command)):
        yield (*here, "command"), wrong
    if "hold" in action and press is None:
        yield (*here, "hold"), "needs a press beside it, for a short press"


def _command_error(command: str) -> str:
    try:
        parse_command(command)
    except (ValueError, TeleopError) as error:
        return f": {error}"
    return ""


def _wheel_rules(control: Mapping[str, Any], here: Location) -> Iterator[Wrong]:
    if "fine" in control and "fine_button" not in control:
        yield (*here, "fine"), "needs a fine_button"
    if "fine_button" in control and "fine" not in control:
        yield (*here, "fine_button"), "needs fine: what a click is worth meanwhile"
    ends = sequence(control, "range")
    if len(ends) == 2 and ends[0] == ends[1]:
        yield (*here, "range"), "must have two different ends"
