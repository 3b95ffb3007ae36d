"""What an operator's hand says: the values that an input device hands to the `Operator`.

An input (a joystick, a dial, the terminal's keys) knows its device and the mapping of its controls; it knows nothing
of the rig. What it says is already shaped (center, inversion, dead zone, expo), but not yet scaled: speed range,
enabling, presets and stops are the operator's, so that they are the same whatever is in the hand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple, Protocol

from teleop.core.axes import Axis
from teleop.core.events import DeviceCommand


class Command(StrEnum):
    """What a button or a key asks for; `Press.number` is that of the preset, `Press.device_command` what TELL sends."""

    STOP = "stop"  # latched
    CLEAR = "clear"  # of the STOP
    ENABLE = "enable"  # for inputs that cannot be held: on, and off again; with a number 1 on, 2 off
    SLOWER = "slower"
    FASTER = "faster"
    RANGE = "range"  # the next speed range, after the last the first
    RECALL = "recall"
    STORE = "store"
    DELETE = "delete"
    RECENTER = "recenter"
    RECORD = "record"  # on, and off again
    SHUTTER = "shutter"
    TELL = "tell"  # a device's own command: `gimbal follow lock`; a typed target: `target door,4.2`
    ENGAGE = "engage"  # the drone
    DISENGAGE = "disengage"
    QUIT = "quit"
    PAUSE = "pause"  # of a run, on its path, and on again
    NEXT = "next"  # keyframe
    PREVIOUS = "previous"
    GO = "go"  # for a run that waits for it
    KEEP = "keep"  # the trim of a sequence, in a file


class Press(NamedTuple):
    """`by` is whose it is, where that is another name than the input's."""

    command: Command
    number: int = 0
    device_command: DeviceCommand | None = None
    by: str = ""


@dataclass(frozen=True, slots=True)
class Held:
    """An input at one tick.

    `deflections` are -1..1 of the axes that it is mapped to, centered ones as 0; `steps` are units by which an axis is
    to be moved on since the last read (a dial by clicks); `positions` are where sliders say that an axis is to be, 0..1
    of the way between its soft limits; `dial` is -1..1 for the gimbal's own dial. `enabled` is
    whether the enable button is held, None for an input that has none. `trouble` says why it cannot be trusted now, ""
    when it can: unplugged, silent for 0.2 s. What it held before is then no longer true. `notes` are lines that the
    operator is to read once. `click` is what one step of `steps` is worth, in units; without it they are one step.
    `stop` is why a STOP of this input does not count now, "" where it does, None for an input that has none.
    `deflected` is whether some control is not at rest, also where two of them cancel each other out. `late` says that
    it was not heard for a moment: what it moves stops as fast as it may, and goes on when it is heard again.
    """

    deflections: Mapping[Axis, float] = field(default_factory=dict)
    steps: Mapping[Axis, float] = field(default_factory=dict)
    dial: float = 0.0
    presses: Sequence[Press] = ()
    enabled: bool | None = None
    trouble: str = ""
    positions: Mapping[Axis, float] = field(default_factory=dict)
    notes: Sequence[str] = ()
    click: Mapping[Axis, float] = field(default_factory=dict, compare=False)
    stop: str | None = field(default=None, compare=False)
    deflected: bool = field(default=False, compare=False)
    late: str = field(default="", compare=False)


class Input(Protocol):
    """A device in an operator's hand."""

    @property
    def name(self) -> str: ...

    def read(self, now: float) -> Held:
        """What it says at `now` (s, the loop's clock); never waits, and never raises for a device that is gone."""
        ...
