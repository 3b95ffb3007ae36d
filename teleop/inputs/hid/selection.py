"""Which of the devices that are plugged in an input of the profile stands for."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from teleop.config.inputs_section import DeviceSection
from teleop.inputs.hid.backend import DeviceInfo, same_model, unit
from teleop.inputs.hid.descriptor.identity import STICKS
from teleop.inputs.hid.pads import fits, pad_for

_OTHER_HANDS = frozenset({(0x01, 0x02), (0x01, 0x06), (0x01, 0x07)})  # mouse, keyboard, keypad


def together(infos: Sequence[DeviceInfo]) -> list[list[DeviceInfo]]:
    """The devices, each with its other interfaces behind the one that comes first.

    Two devices of a model have each of their numbers twice, so that with no serial number and no port to be seen two
    numbers are two interfaces of one.
    """
    groups: list[list[DeviceInfo]] = []
    for info in infos:
        for group in groups:
            first = group[0]
            placed = (info.serial, info.port) != ("", "") or min(info.interface, first.interface) >= 0
            one_device = placed and same_model(info, first) and (info.serial, info.port) == (first.serial, first.port)
            if info.path in [each.path for each in group]:
                break  # the system lists an interface once for each of its usages
            if one_device and info.interface not in [each.interface for each in group]:
                group.append(info)
                break
        else:
            groups.append([info])
    return groups


def wanted(
    device: DeviceSection, found: Sequence[DeviceInfo], last: DeviceInfo | None, stayed: Collection[bytes] = ()
) -> Sequence[DeviceInfo]:
    """The devices that `device` may stand for, the best first.

    After an unplugging that is the `last` one, then its like, then a spare plugged in since: another
    model that had been there all along (`stayed`, by path) was not meant. A keyboard or a mouse is taken only where its
    ids are asked for, anything else that is no joystick and no known pad where its name is.
    """
    fitting = [info for info in found if fits(device, info) and (device.vendor is not None or _for_hands(device, info))]
    if last is not None:
        fitting = [info for info in fitting if same_model(info, last) or info.path not in stayed]

    def rank(info: DeviceInfo) -> tuple[bool, bool, bool, bool, bool, bytes]:
        usage = (info.usage_page, info.usage)
        other = last is not None and not same_model(info, last)
        same = last is None or unit(info) == unit(last)
        serial = last.serial if last is not None else ""
        return other, info.serial != serial, not same, usage not in STICKS, usage in _OTHER_HANDS, info.path

    return sorted(fitting, key=rank)


def _for_hands(device: DeviceSection, info: DeviceInfo) -> bool:
    usage = (info.usage_page, info.usage)
    if usage in STICKS or pad_for(info):
        return usage not in _OTHER_HANDS
    return not device.any and info.usage_page != 0 and usage not in _OTHER_HANDS  # 0: the system does not say
