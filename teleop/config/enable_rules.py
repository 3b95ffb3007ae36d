"""The `enable:` of an input is one thing: a button to hold while its controls may move anything.

It cannot do something else as well: who holds it would do that, and who does that would let the axes move. What the
profile and its pad say is checked before anything opens; what the device has, and what its own mapping does with the
button, once it is plugged in.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from teleop.config.documents.document import DocumentError, Wrong, mapping, sequence
from teleop.config.inputs_section import DIRECTIONS, ControlSection
from teleop.config.pad_file import load_pad
from teleop.core.operator_input import Command

BUTTON_TO_HOLD = "is a press, and enable is a button to hold: name it with enable: beside controls:"
SHOWN = 12  # names of controls, at most, in a line


def enable_rules(data: Any) -> Iterator[Wrong]:
    """What is wrong with each `enable` of a profile's `inputs`; `data` is the whole profile, unchecked."""
    for index, section in enumerate(sequence(data, "inputs")):
        own = mapping(section, "controls")
        for name, control in own.items():
            for place, action in _actions(name, mapping(control)):
                if Command.ENABLE in (action.get("press"), action.get("hold")):
                    yield (
                        ("inputs", index, "controls", *place),
                        BUTTON_TO_HOLD,
                    )
        enable = mapping(section).get("enable")
        if isinstance(enable, str):
            controls = {**_of_pad(mapping(section).get("pad")), **own}
            if does := does_already(enable, controls):
                cure = f"take another, or free it with controls: {{{enable}: null}}"
                yield ("inputs", index, "enable"), f"{enable} already is {does}: {cure}"


def enable_trouble(enable: str | None, names: Collection[str], controls: Mapping[str, ControlSection]) -> str:
    """Why this button of a device with controls of these `names`, mapped like this, cannot enable; "" where it can."""
    if not enable:
        return ""
    if enable not in names:
        buttons = [name for name in names if name.startswith("Button ")] or list(names)
        shown = sorted(buttons, key=lambda name: (len(name), name))[:SHOWN]
        return f"enable: it has no {enable}; it has {', '.join(shown)}"
    raw = {name: control.model_dump(exclude_none=True) for name, control in controls.items()}
    does = does_already(enable, raw)
    return f"enable: {enable} already is {does}; take another" if does else ""


def does_already(enable: str, controls: Mapping[str, Any]) -> str:
    """What a button does in these controls, in a few words, "" for nothing; a control that is None does nothing."""
    for name, control in controls.items():
        for place, action in _actions(name, mapping(control)):
            if enable != " ".join(place):
                continue
            if does := action.get("press") or action.get("axis"):
                return str(does)
            if action.get("dial"):
                return "the dial"
            if any(mapping(action).get(direction) for direction in DIRECTIONS):
                return "several directions"
        if mapping(control).get("fine_button") == enable:
            return f"the fine button of {name}"
    return ""


def _actions(name: str, control: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], Mapping[str, Any]]]:
    """A control, and each direction of a hat, with where it stands."""
    yield (name,), control
    for direction in DIRECTIONS:
        if control.get(direction) is not None:
            yield (name, direction), mapping(control, direction)


def _of_pad(pad: Any) -> Mapping[str, Any]:
    """The controls of a pad, as far as it can be read: what is wrong with it is another rule's."""
    if not isinstance(pad, str):
        return {}
    try:
        return {name: control and control.model_dump() for name, control in load_pad(pad).controls.items()}
    except DocumentError:
        return {}
