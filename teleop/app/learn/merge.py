"""The `inputs:` of a profile with what was learned in them: as plain data, out of plain data.

What was asked for and answered is replaced, everything else of the profile stays: a skipped question keeps its control.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from copy import deepcopy
from typing import Any

from teleop.app.learn.answers import Answers, hat_direction
from teleop.config.documents.document import mapping
from teleop.config.documents.yaml_edit import Commented, Hexadecimal
from teleop.config.inputs_section import DIRECTIONS, DeviceSection
from teleop.config.pad_file import load_pad
from teleop.inputs.hid.backend import DeviceInfo, described
from teleop.inputs.hid.pads import fits

_SHAPING = ("dead_zone", "expo", "speed", "coarse", "fine", "fine_button", "range", "center", "value_type")
"""Keys that stay with a control that keeps its axis."""


def device_keys(info: DeviceInfo, others: Sequence[DeviceInfo]) -> Mapping[str, Any]:
    """The `device:` that stands for this device alone, beside `others` that are plugged in."""
    ids = {"vendor": Hexadecimal(info.vendor_id), "product": Hexadecimal(info.product_id)}
    keys = Commented(ids if info.vendor_id or not info.name else {"name": info.name})
    keys.comment = "".join(filter(str.isprintable, described(info)))
    like = [other for other in others if (other.vendor_id, other.product_id) == (info.vendor_id, info.product_id)]
    if any((other.serial, other.port) != (info.serial, info.port) for other in like):
        keys.update({"serial": info.serial} if info.serial else {"port": info.port} if info.port else {})
    if any(other.interface != info.interface for other in like) and info.interface >= 0:
        keys["interface"] = info.interface
    return keys


def merged(
    inputs: Any, answers: Answers, infos: Sequence[DeviceInfo], hats: Sequence[Sequence[str]]
) -> list[dict[str, Any]]:
    """The `inputs` of a profile with the `answers` in them; `infos` are the devices, `hats` the names of their hats.

    An entry that stands for a device is updated; without one the device gets a new entry at the end.
    """
    entries: list[dict[str, Any]] = deepcopy(inputs) if isinstance(inputs, list) else []
    used: set[int] = set()
    for device in answers.devices:
        index = entry_for(infos[device], entries, used)
        if index is None:
            others = [info for info in infos if info.path != infos[device].path]
            index = len(entries)
            entries.append({"device": device_keys(infos[device], others)})
        used.add(index)
        _update(entries[index], answers, device, hats[device])
    return entries


def entry_for(info: DeviceInfo, entries: Sequence[Any], used: set[int]) -> int | None:
    """The entry that stands for the device, by its most exact `device:`; none of those already `used`."""
    fitting = [
        (_section(entry).exactness, -index)
        for index, entry in enumerate(entries)
        if index not in used and fits(_section(entry), info)
    ]
    return -max(fitting)[1] if fitting else None


def _section(entry: Any) -> DeviceSection:
    return DeviceSection.model_validate(dict(mapping(entry, "device")))


def _update(entry: dict[str, Any], answers: Answers, device: int, hats: Sequence[str]) -> None:
    learned, enable = answers.controls(device), answers.enable(device)
    pad = _pad_controls(entry.get("pad"))
    own: dict[str, Any] = dict(mapping(entry, "controls"))
    for name, direction in _replaced(answers, {**pad, **own}, learned, enable):
        _take(own, pad, name, direction)
    for name, action in learned.items():
        hat, direction = hat_direction(name, hats)
        before = own[hat] if hat in own else deepcopy(pad.get(hat))
        if direction:
            directions = {key: before[key] for key in DIRECTIONS if before and before.get(key) is not None}
            own[hat] = {**directions, direction: _with_kept(directions.get(direction), action)}
        else:
            own[name] = _with_kept(before, action)
    if enable:
        entry["enable"] = enable
    if own or learned or "controls" in entry:
        entry["controls"] = own


def _replaced(
    answers: Answers, controls: Mapping[str, Any], learned: Collection[str], enable: str | None
) -> list[tuple[str, str]]:
    """The controls, and directions of hats, that do what another one does from now on; and the new enable button."""
    asked = answers.questions()
    found: list[tuple[str, str]] = []
    for name, control in controls.items():
        directions = {key: mapping(control, key) for key in DIRECTIONS if mapping(control, key)}
        for direction, action in (directions or {"": mapping(control)}).items():
            whole = f"{name} {direction}".rstrip()
            answered = whole not in learned and any(question.is_answered_by(action) for question in asked)
            if answered or (action and whole == enable):
                found.append((name, direction))
    return found


def _take(own: dict[str, Any], pad: Mapping[str, Any], name: str, direction: str) -> None:
    """Leave a control out, or one direction of a hat."""
    kept = {}
    if direction:
        before = mapping(own.get(name, pad.get(name)))
        kept = {key: value for key, value in before.items() if key != direction and value is not None}
    if kept:
        own[name] = kept
    elif name in pad:
        own[name] = None
    else:
        own.pop(name, None)


def _with_kept(before: Any, action: Mapping[str, Any]) -> dict[str, Any]:
    """The action, with the other keys of a control that does the same already; its keys in their old order."""
    before = mapping(before)
    if any(before.get(key) != action.get(key) for key in ("axis", "dial", "press")):
        return dict(action)
    kept = _SHAPING if "press" not in action else ("hold", "number", "command")
    order = [*(key for key in before if key in action or key in kept), *action]
    return {key: action.get(key, before.get(key)) for key in order}


def _pad_controls(pad: Any) -> dict[str, Any]:
    """The controls of the pad that an entry names, as plain data."""
    if not isinstance(pad, str):
        return {}
    return {
        name: control.model_dump(mode="json", exclude_defaults=True)
        for name, control in load_pad(pad).controls.items()
        if control is not None
    }
