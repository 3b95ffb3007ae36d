"""Which mapping a device gets: a shipped one by its ids or its driver, or one that is guessed from the controls it has.

The guess for a pad without a description: the left stick (X, Y) is pan and tilt, the right one (Rx and Ry, or Z and Rz,
whichever rests in its middle) roll and focus; a joystick's twist (Rz without a Z) is roll. The puck of a multi-axis
controller turns as the head is to turn. HID counts Y downwards, and up is to be up. Button 1, a joystick's trigger and
the first under a thumb, is STOP, which does no harm when pressed unasked; 2 clears it, 3 records, 4 recenters, 5
and 6 (the shoulders) are slower and faster. The hat recalls presets 1 to 4 and, held, stores them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache

from teleop.config.inputs_section import (
    DIRECTIONS,
    PADS,
    STUCK_TIMEOUT,
    ActionSection,
    ControlSection,
    DeviceSection,
    InputSection,
    PadDeviceSection,
    PadSection,
)
from teleop.config.pad_file import load_pad
from teleop.config.resources import folder
from teleop.core.axes import Axis
from teleop.core.operator_input import Command
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.descriptor.identity import MULTI_AXIS

_BUTTONS = (
    ("Button 1", Command.STOP),
    ("Button 2", Command.CLEAR),
    ("Button 3", Command.RECORD),
    ("Button 4", Command.RECENTER),
    ("Button 5", Command.SLOWER),
    ("Button 6", Command.FASTER),
)


@dataclass(frozen=True)
class Chosen:
    """What a device does; `guessed`: not from a file. `unreadable` says why its reports cannot be used."""

    controls: Mapping[str, ControlSection] = field(default_factory=dict)
    reports: str = "auto"
    stuck_timeout: float = STUCK_TIMEOUT
    guessed: bool = False
    unreadable: str = ""


@cache
def shipped() -> Sequence[PadSection]:
    """Every mapping that comes with the program."""
    return tuple(load_pad(file.stem) for file in sorted(folder(PADS).glob("*.yaml")))


def pad_for(info: DeviceInfo) -> PadSection | None:
    """The shipped mapping for this very device."""
    return next((pad for pad in shipped() if any(_is_for(device, info) for device in pad.devices)), None)


def _is_for(device: PadDeviceSection, info: DeviceInfo) -> bool:
    """A mapping by the names of a descriptor is for no device whose controls a driver has named, nor the other way."""
    return (device.driver or "") == info.driver and fits(device, info)


def fits(device: DeviceSection, info: DeviceInfo) -> bool:
    """Whether this is the device, by its ids, its name and where it is; a section for any device fits all."""
    return (
        device.vendor in (None, info.vendor_id)
        and device.product in (None, info.product_id)
        and device.serial in (None, info.serial)
        and device.port in (None, info.port)
        and device.interface in (None, info.interface)
        and (device.name is None or is_named(info, device.name))
    )


def is_named(info: DeviceInfo, written: str) -> bool:
    """Whether it has the name that was written, in which * is any letters; a name with brackets is also just that."""
    from fnmatch import fnmatch

    name, written = info.name.casefold(), written.casefold()
    return name == written or fnmatch(name, written)


def stops(control: ControlSection) -> bool:
    """Whether it is a STOP, in one of its directions maybe."""
    parts = [control, *(getattr(control, direction) for direction in DIRECTIONS)]
    return any(Command.STOP in (part.press, part.hold) for part in parts if part is not None)


def may_stop(section: InputSection) -> bool:
    """Whether the device that is plugged in for it may have a STOP: by what is written, else that is the device's."""
    if not section.pad and not section.controls:
        return True
    controls = {**(load_pad(section.pad).controls if section.pad else {}), **section.controls}
    return any(stops(control) for control in controls.values() if control is not None)


def choose(section: InputSection, info: DeviceInfo, names: Collection[str]) -> Chosen:
    """What the device does that `section` is for; a guess is made for the controls of these `names`."""
    named = load_pad(section.pad) if section.pad else None
    pad = named or (None if section.controls else pad_for(info))
    if pad is None and not section.controls:
        multi_axis = (info.usage_page, info.usage) == MULTI_AXIS
        return Chosen(
            guess(names, multi_axis),
            section.reports or ("on-change" if multi_axis else "auto"),
            section.stuck_timeout or STUCK_TIMEOUT,
            guessed=True,
        )
    merged = {**(pad.controls if pad else {}), **section.controls}
    return Chosen(
        {name: control for name, control in merged.items() if control is not None},
        section.reports or (pad and pad.reports) or "auto",
        section.stuck_timeout or (pad and pad.stuck_timeout) or STUCK_TIMEOUT,
        unreadable=pad.unreadable if pad else "",
    )


def guess(names: Collection[str], multi_axis: bool) -> Mapping[str, ControlSection]:
    """A guessed mapping for a device with these controls; see the module."""
    axes = {
        "X": ControlSection(axis=Axis.PAN),
        "Y": ControlSection(axis=Axis.TILT, invert=True),
        "Rx": ControlSection(axis=Axis.ROLL),
        "Ry": ControlSection(axis=Axis.FOCUS, invert=True),
        "Z": ControlSection(axis=Axis.ROLL),
        "Rz": ControlSection(axis=Axis.FOCUS, invert=True) if "Z" in names else ControlSection(axis=Axis.ROLL),
    }
    if multi_axis:
        turns = {"Rx": (Axis.TILT, False), "Ry": (Axis.ROLL, True), "Rz": (Axis.PAN, False)}
        axes = {
            name: ControlSection(axis=axis, invert=invert, value_type="absolute")
            for name, (axis, invert) in turns.items()
        }
    buttons = {name: ControlSection(press=command) for name, command in _BUTTONS}
    presets = {
        direction: ActionSection(press=Command.RECALL, number=number, hold=Command.STORE)
        for number, direction in enumerate(DIRECTIONS, 1)
    }
    every = {**axes, **buttons, "Hat switch": ControlSection.model_validate(presets)}
    return {name: section for name, section in every.items() if name in names}
