"""The controls of a device, each read by what it is: an absolute one by where it is, a wheel by its counts, a button by
its changes, so that neither a click nor a press between two looks is lost.

What they say is put together in one `ControlValues`; a control that has no value (a null state) says nothing.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from teleop.config.device_commands import parse_command
from teleop.config.inputs_section import ActionSection, ControlSection
from teleop.core.axes import Axis
from teleop.core.operator_input import Command, Press
from teleop.inputs.hid.state import Change, Sample
from teleop.inputs.stick_shaping import Centre, deflect, shape, share

HOLD = 1.0  # s: pressed for longer is held
CLICKS_WITHIN = 0.25  # s over which clicks are counted to a speed: a wheel turned slowly still clicks in it
MOVED = 0.01  # of its range: a slider says nothing before it has been moved that far, so that nothing jumps to it
CLICK: Mapping[Axis, float] = {Axis.PAN: 1.0, Axis.TILT: 1.0, Axis.ROLL: 1.0, Axis.FOCUS: 0.01}
"""What a click of a wheel moves an axis by, in its units, where a profile says nothing; others: a hundredth."""

CLICK_RATE = 0.05  # of full deflection, for one click per second


@dataclass
class ControlValues:
    """One look at all controls, being put together."""

    deflections: dict[Axis, float] = field(default_factory=dict)
    steps: dict[Axis, float] = field(default_factory=dict)
    click: dict[Axis, float] = field(default_factory=dict)  # what the longest of the steps is worth
    positions: dict[Axis, float] = field(default_factory=dict)
    dial: float = 0.0
    presses: list[Press] = field(default_factory=list)

    def deflect(self, section: ControlSection, deflection: float) -> None:
        deflection *= -section.speed if section.invert else section.speed
        if section.axis is None:
            self.dial = _limited(self.dial + deflection)
        else:
            self.deflections[section.axis] = _limited(self.deflections.get(section.axis, 0.0) + deflection)


class ControlReader(Protocol):
    """Reads one control; `fine`: its fine button is held."""

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, said: ControlValues) -> None: ...


class Stick:
    """Deflects its axis by where it is: a stick from its middle, a trigger or a button from its end."""

    def __init__(self, section: ControlSection, dead_zone: float, expo: float, guessed: bool) -> None:
        self._section, self._guessed = section, guessed
        self._dead_zone = dead_zone if section.dead_zone is None else section.dead_zone
        self._expo = expo if section.expo is None else section.expo
        self._centre: Centre | None = None

    @property
    def finding(self) -> bool:
        return self._centre is not None and self._centre.value is None

    @property
    def uncentred(self) -> bool:
        return self._centre is not None and not self._centre.centred

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, said: ControlValues) -> None:  # noqa: ARG002
        section = self._section
        low, high = section.range or (sample.minimum, sample.maximum)
        if sample.null or low == high:
            return
        if (section.rest or ("low" if (low, high) == (0, 1) else "middle")) == "middle":
            self._centre = self._centre or Centre(low, high, section.center)
            self._centre.see(sample.value, now)
            if self._centre.value is None or (self._guessed and not self._centre.centred):
                return
            deflection = deflect(sample.value, low, self._centre.value, high)
        elif section.rest == "high":
            deflection = share(sample.value, high, low)
        else:
            deflection = share(sample.value, low, high)
        worth = section.fine if fine else section.coarse
        said.deflect(section, _limited((worth or 1.0) * shape(deflection, self._dead_zone, self._expo)))


class Lever:
    """Says where its axis is to be, as a share of the way between its soft limits, once it has been moved."""

    def __init__(self, section: ControlSection) -> None:
        self._section = section
        self._first: float | None = None
        self._moved = False

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, said: ControlValues) -> None:  # noqa: ARG002
        low, high = self._section.range or (sample.minimum, sample.maximum)
        if sample.null or low == high or self._section.axis is None:
            return
        position = share(sample.value, high, low) if self._section.invert else share(sample.value, low, high)
        self._first = position if self._first is None else self._first
        self._moved = self._moved or abs(position - self._first) >= MOVED
        if self._moved:
            said.positions[self._section.axis] = position


class Wheel:
    """Moves its axis on by clicks or, by rate, deflects it by how fast they come."""

    def __init__(self, section: ControlSection, counter: bool) -> None:
        self._section, self._counter = section, counter
        self._steps = section.axis is not None and section.by != "rate"
        click = CLICK.get(section.axis, 0.01) if section.axis is not None and self._steps else CLICK_RATE
        self._coarse = section.coarse or click
        self._at: float | None = None  # where a running counter was
        self._recent: deque[tuple[float, float]] = deque()

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, said: ControlValues) -> None:
        clicks = [(change.time, self._clicks(change.sample)) for change in changes]
        if self._at is None:
            self._at = sample.value
        worth = (self._section.fine if fine else None) or self._coarse
        if self._steps and self._section.axis is not None:
            sign, click, axis = -1 if self._section.invert else 1, self._section.speed * worth, self._section.axis
            moved = sign * click * sum(count for _, count in clicks)
            said.steps[axis] = said.steps.get(axis, 0.0) + moved
            said.click[axis] = max(said.click.get(axis, 0.0), click if moved else 0.0)
            return
        self._recent.extend(clicks)
        while self._recent and self._recent[0][0] <= now - CLICKS_WITHIN:
            self._recent.popleft()
        rate = sum(count for _, count in self._recent) / CLICKS_WITHIN
        said.deflect(self._section, _limited(worth * rate))

    def _clicks(self, sample: Sample) -> float:
        if not self._counter:
            return sample.value
        before, self._at = self._at, sample.value
        if before is None or sample.null:
            return 0.0
        turn = abs(sample.maximum - sample.minimum) + 1
        return (sample.value - before + turn / 2) % turn - turn / 2


class Button:
    """Asks for something when pressed or, when it has something else for being held, when let go or held."""

    def __init__(self, section: ControlSection) -> None:
        self._press = _press(section, section.press)
        self._hold = _press(section, section.hold)
        self._pressed: bool | None = None
        self._since = math.inf  # when it was pressed and has not asked for anything yet

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, said: ControlValues) -> None:  # noqa: ARG002
        if self._pressed is None:
            self._pressed = _pressed_before(changes) if changes else sample.pressed
        for change in changes:
            if change.sample.pressed != self._pressed:
                self._pressed = change.sample.pressed
                self._turned(change.time, said)
        if now - self._since >= HOLD and self._hold:
            said.presses.append(self._hold)
            self._since = math.inf

    def _turned(self, time: float, said: ControlValues) -> None:
        if self._pressed and self._hold:
            self._since = time
        elif self._pressed and self._press:
            said.presses.append(self._press)
        elif not self._pressed and self._press and self._since < math.inf:
            said.presses.append(self._hold if self._hold and time - self._since >= HOLD else self._press)
            self._since = math.inf


def _pressed_before(changes: Sequence[Change]) -> bool:
    """Whether a button was pressed before its first change that anybody saw: of two values it had the other."""
    first = changes[0].sample
    return not first.pressed if first.maximum - first.minimum == 1 else first.pressed


def _press(section: ActionSection, command: Command | None) -> Press | None:
    if command is None:
        return None
    return Press(command, section.number or 0, parse_command(section.command) if section.command else None)


def _limited(value: float) -> float:
    return min(max(value, -1.0), 1.0)
