"""The learned mapping, tried: what each control does, by the code that reads the inputs of a profile in a run.

No link of the rig is opened: nothing moves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import NamedTuple, Self

from teleop.config.inputs_section import DIRECTIONS, ActionSection, ControlSection, InputSection
from teleop.config.pad_file import load_pad
from teleop.config.profile import Profile
from teleop.core.axes import Limits
from teleop.core.errors import DeviceError
from teleop.core.operator_input import Held, Press
from teleop.inputs.hid.backend import HidBackend
from teleop.inputs.hid.controls import ControlValues
from teleop.inputs.hid.device import HidInput, open_inputs

SHOWN = 1.0  # s for which a press is shown


class Row(NamedTuple):
    """A control: what it does by the profile, and what it asks for now; `is_active`: it does ask for something."""

    input: int
    control: str
    action: ActionSection | None  # None: the enable button
    does: str
    asks: str
    is_active: bool


@dataclass
class _Kept:
    """What has been seen of a control that says a thing only once."""

    steps: float = 0.0
    press: str = ""
    until: float = 0.0


class Trial:
    """The inputs of this profile, open while it is entered; `rows` and `notes` are as of the last `read`."""

    def __init__(self, profile: Profile, backend: HidBackend, now: Callable[[], float], polled: bool) -> None:
        self._profile, self._backend, self._now, self._polled = profile, backend, now, polled
        self._stack = ExitStack()
        self._inputs: Sequence[HidInput] = ()
        self._kept: dict[tuple[int, str], _Kept] = {}
        self.rows: Sequence[Row] = ()
        self.notes: Sequence[str] = ()

    def __enter__(self) -> Self:
        shaping = self._profile.sticks
        opened = open_inputs(
            *(self._profile.inputs, self._now, self._backend),
            dead_zone=shaping.dead_zone,
            expo=shaping.expo,
            polled=self._polled,
        )
        self._inputs = self._stack.enter_context(opened)
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    @property
    def names(self) -> Sequence[str]:
        """What each input is called."""
        return [each.name for each in self._inputs]

    def read(self, now: float) -> None:
        """Raises DeviceError when an input is unplugged."""
        rows: list[Row] = []
        notes: list[str] = []
        for index, each in enumerate(self._inputs):
            if each.mapped is not None and each.mapped.each is None:
                each.mapped.each = {}
            held = each.read(now)
            if each.is_lost:
                raise DeviceError(f"{held.trouble or each.name}; nothing was written")
            notes += [held.trouble] if held.trouble else []
            asked = (each.mapped and each.mapped.each) or {}
            rows += self._rows(index, self._profile.inputs[index], held, asked, now)
        self.rows, self.notes = rows, notes

    def _rows(
        self, index: int, section: InputSection, held: Held, asked: Mapping[str, ControlValues], now: float
    ) -> list[Row]:
        rows = []
        for name, action in _flat(_controls(section)):
            kept = self._kept.setdefault((index, name), _Kept())
            text, is_active = self._asked(asked.get(name), kept, now)
            rows.append(Row(index, name, action, words(action), text, is_active))
        if section.enable:
            rows.append(Row(index, section.enable, None, "enable", "held" if held.enabled else "", bool(held.enabled)))
        return rows

    def _asked(self, values: ControlValues | None, kept: _Kept, now: float) -> tuple[str, bool]:
        """What a control asks for, in a few words, and whether that is something."""
        if values is None:
            return "", False
        for press in values.presses:
            kept.press, kept.until = _press_words(press), now + SHOWN
        for axis, deflection in values.deflections.items():
            return f"{axis} {deflection + 0.0:+.2f}", bool(deflection)
        for axis, share in values.positions.items():
            return f"{axis} at {_position(share, self._profile.limits.get(axis)):.2f}", False
        for axis, step in values.steps.items():
            kept.steps += step
            return f"{axis} {kept.steps + 0.0:+.3f}", bool(step)
        if values.dial:
            return f"dial {values.dial:+.2f}", True
        is_pressed = now < kept.until
        return (kept.press if is_pressed else ""), is_pressed


def words(action: ActionSection) -> str:
    """What a control does by the profile."""
    number = f" {action.number}" if action.number is not None else ""
    hold = f", held: {action.hold}{number}" if action.hold else ""
    if action.press:
        return f"{_named(action.press)}{number}{hold}{f' {action.command}' if action.command else ''}"
    moved = str(action.axis) if action.axis else "dial"
    by = " position" if isinstance(action, ControlSection) and action.by == "position" else ""
    return f"{moved}{by}{', inverted' if action.invert else ''}"


def _named(command: str) -> str:
    return "STOP" if command == "stop" else str(command)


def _press_words(press: Press) -> str:
    return f"{_named(press.command)}{f' {press.number}' if press.number else ''}"


def _position(share: float, limits: Limits | None) -> float:
    """The share of the way between the soft limits as a position; of an axis without them the share."""
    if limits is None or abs(limits.minimum) == float("inf"):
        return share
    return limits.minimum + share * (limits.maximum - limits.minimum)


def _controls(section: InputSection) -> Mapping[str, ControlSection | None]:
    """With those of the pad that it names."""
    return {**(load_pad(section.pad).controls if section.pad else {}), **section.controls}


def _flat(controls: Mapping[str, ControlSection | None]) -> Sequence[tuple[str, ActionSection]]:
    """Each control, and each direction of a hat by its own name."""
    flat: list[tuple[str, ActionSection]] = []
    for name, section in controls.items():
        if section is None:
            continue
        directions = [(f"{name} {key}", each) for key in DIRECTIONS if (each := getattr(section, key)) is not None]
        flat += directions or [(name, section)]
    return flat
