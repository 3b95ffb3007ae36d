"""Which input of a profile may take which device, where several could take the same.

A device is for the input that had it before, else for the one that names it most exactly. Where two devices of a model
are plugged in and two inputs name both of them equally exactly, neither input takes one: which hand moves which axis
would depend on the order in which the system lists them. One such device alone is for the first of these inputs.
"""

from __future__ import annotations

import json
import re
import threading
from collections.abc import Collection, Sequence

from teleop.config.inputs_section import InputSection
from teleop.inputs.hid.backend import DeviceInfo, described, same_device, same_model, unit
from teleop.inputs.hid.descriptor.identity import NOT_STICKS, STICKS
from teleop.inputs.hid.pads import fits

_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9-]*|\d+-[\d.]+")  # what YAML takes for text without quotes: A1B2, port 1-2.3


class Claims:
    """Devices that are taken, by their paths, and whose each is: shared by the readers of these `sections`.

    `exchangeable`: it does not matter which of two inputs has which of two devices, as where only their STOP counts.
    """

    def __init__(self, sections: Sequence[InputSection] = (), exchangeable: bool = False) -> None:
        self._lock = threading.Lock()
        self._sections, self._exchangeable = sections, exchangeable
        self._taken: dict[bytes, int] = {}  # path -> identity of the section
        self._last: dict[int, DeviceInfo] = {}  # the device of each section, by its identity

    def take(self, path: bytes, section: InputSection | None = None) -> bool:
        with self._lock:
            free = path not in self._taken
            if free:
                self._taken[path] = id(section)
            return free

    def release(self, path: bytes) -> None:
        with self._lock:
            self._taken.pop(path, None)

    def remember(self, section: InputSection, info: DeviceInfo) -> None:
        """This device is that section's, also while it is unplugged."""
        with self._lock:
            self._last[id(section)] = info

    def is_for_another(self, section: InputSection, info: DeviceInfo) -> bool:
        """Whether another section has had this device, or names it more exactly."""
        with self._lock:
            others = {key: last for key, last in self._last.items() if key != id(section)}
            held = {key: path for path, key in self._taken.items()}
        # one that holds another device now is not the one that had this: clones may have one serial number
        if any(unit(info) == unit(last) and held.get(key, info.path) == info.path for key, last in others.items()):
            return True
        return any(each.device.exactness > section.device.exactness for each in self._others(section, info))

    def is_for_one_before(self, section: InputSection, info: DeviceInfo) -> bool:
        """Whether a section in front of this one, which has had no device yet, may take it as well as this one."""
        with self._lock:
            provided = {*self._last, *self._taken.values()}
        equals = {id(each) for each in self._equals(section, info)}
        before = [id(each) for each in self._sections]
        before = before[: before.index(id(section))] if id(section) in before else []
        return id(section) not in provided and any(key in equals and key not in provided for key in before)

    def shared(self, section: InputSection, info: DeviceInfo) -> bool:
        """Whether another section names it equally exactly."""
        return bool(self._equals(section, info))

    def doubt(self, section: InputSection, info: DeviceInfo, found: Collection[DeviceInfo]) -> str:
        """Why it is not clear whether this device is for `section` or another one, and the cure; "" where it is."""
        with self._lock:
            last = self._last.get(id(section))
        if self._exchangeable or (last is not None and unit(last) == unit(info)):
            return ""
        for other in self._equals(section, info):
            rivals = [
                each
                for each in found
                if _are_two(each, info) and fits(section.device, each) and other in self._equals(section, each)
            ]
            if rivals and not (section.device.any and other == section):
                return _in_doubt(section, other, [info, *rivals])
        return ""

    def _others(self, section: InputSection, info: DeviceInfo) -> list[InputSection]:
        return [each for each in self._sections if each is not section and fits(each.device, info)]

    def _equals(self, section: InputSection, info: DeviceInfo) -> list[InputSection]:
        return [each for each in self._others(section, info) if each.device.exactness == section.device.exactness]


def _are_two(one: DeviceInfo, two: DeviceInfo) -> bool:
    """Whether these are two devices of one model, or two joysticks in one (an adapter); a mouse beside it is none."""
    usages = [(info.usage_page, info.usage) for info in (one, two)]
    if one.path == two.path or not same_model(one, two) or any(usage in NOT_STICKS for usage in usages):
        return False
    return not same_device(one, two) or all(usage in STICKS for usage in usages)


def _written(value: str | int) -> str:
    """A value as a profile has it: a serial number of digits is in quotes, or it would be read as a number."""
    return str(value) if isinstance(value, int) or _PLAIN.fullmatch(value) else json.dumps(value)


def _in_doubt(section: InputSection, other: InputSection, devices: Sequence[DeviceInfo]) -> str:
    paths = {info.path: info for info in devices}
    name = other.name or f"another input for {other.device}"
    first = devices[0]
    text = f"{len(paths)} of {described(first)} are plugged in, and {name} is for them too"
    for key in ("serial", "port", "interface"):
        values = [getattr(info, key) for info in paths.values()]
        if all(value not in ("", -1) for value in values) and len(set(values)) == len(values):
            each = " or ".join(f"{key}: {_written(value)}" for value in sorted(values))
            return f"{text}; add {each} to the device of each input"
    return f"{text}; unplug one" if not section.device.any else f"{text}; unplug one, or name each by its device"
