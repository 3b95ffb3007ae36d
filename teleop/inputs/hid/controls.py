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
from teleop.inputs.stick_shaping import Center, deflect, shape, share

HOLD = 1.0  # s: pressed for longer is held
CLICKS_WITHIN = 0.25  # s over which clicks are counted to a speed: a wheel turned slowly still clicks in it
MOVED = 0.01  # of its range: a slider is not moved before it has been moved that far, so that nothing jumps to it
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
    deflected: bool = False
    presses: list[Press] = field(default_factory=list)

    def deflect(self, section: ControlSection, deflection: float) -> None:
        deflection *= -section.speed if section.invert else section.speed
        self.deflected = self.deflected or deflection != 0
        if section.axis is None:
            self.dial = _limited(self.dial + deflection)
        else:
            self.deflections[section.axis] = _limited(self.deflections.get(section.axis, 0.0) + deflection)

    def add(self, other: ControlValues) -> None:
        """What another control asks for too."""
        for axis, deflection in other.deflections.items():
            self.deflections[axis] = _limited(self.deflections.get(axis, 0.0) + deflection)
        for axis, step in other.steps.items():
            self.steps[axis] = self.steps.get(axis, 0.0) + step
            self.click[axis] = max(self.click.get(axis, 0.0), other.click.get(axis, 0.0))
        self.positions.update(other.positions)
        self.dial = _limited(self.dial + other.dial)
        self.deflected = self.deflected or other.deflected
        self.presses.extend(other.presses)


class ControlReader(Protocol):
    """Reads one control; `fine`: its fine button is held."""

    def read(
        self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, values: ControlValues
    ) -> None: ...


class Stick:
    """Deflects its axis by where it is: a stick from its middle, a trigger or a button from its end.

    `known` is its center from before it was unplugged. `guessed`: its mapping is a guess, so it has to be seen
    centered. `puck`: it is a part of a multi-axis controller, whose rest is 0.
    """

    def __init__(
        self,
        section: ControlSection,
        dead_zone: float,
        expo: float,
        guessed: bool,
        known: float | None = None,
        puck: bool = False,
    ) -> None:
        self._section, self._guessed, self._known, self._puck = section, guessed, known, puck
        self._dead_zone = dead_zone if section.dead_zone is None else section.dead_zone
        self._expo = expo if section.expo is None else section.expo
        self.center: Center | None = None
        self.is_trigger = False  # by its guessed mapping, and where it first was (see Pair)
        self.at_center = False
        self.is_inside = False  # deflected, and not to the end of its range
        self.is_deflected = False
        self._seen = self._is_late = self._rested = False

    @property
    def finding(self) -> bool:
        return self.center is not None and self.center.value is None

    @property
    def uncentered(self) -> bool:
        return self.center is not None and not self.center.centered

    @property
    def is_unrested(self) -> bool:
        """Whether it is deflected, came later than the device's first report, and was never seen at rest.

        It may have been held all along; what is in the first report is locked by the input's interlock.
        """
        return self.is_deflected and self._is_late and not self._rested

    def expect(self) -> None:
        """The device has reported: if this one has not, it is late."""
        self._is_late = self._is_late or not self._seen

    @property
    def is_locked(self) -> bool:
        """Whether it moves nothing: a guessed control has to be seen centered once."""
        if self.center is None:
            return False
        return self.center.value is None or (self._guessed and (self.is_trigger or self._unseen))

    @property
    def _unseen(self) -> bool:
        return self.center is not None and not self.center.centered and not self.center.learned

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, values: ControlValues) -> None:  # noqa: ARG002
        section, self._seen = self._section, True
        self.is_inside = self.is_deflected = self.at_center = False
        low, high = section.range or (sample.minimum, sample.maximum)
        if sample.null or low == high:
            return
        if (section.rest or ("low" if (low, high) == (0, 1) else "middle")) == "middle":
            self.center = self.center or Center(low, high, self._given(low, high))
            self.center.see(sample.value, now)
            self.at_center = self.center.has(sample.value)
            if self.is_locked or self.center.value is None:
                return
            deflection = deflect(sample.value, low, self.center.value, high)
        elif section.rest == "high":
            deflection = share(sample.value, high, low)
        else:
            deflection = share(sample.value, low, high)
        factor = section.fine if fine else section.coarse
        shaped = shape(deflection, self._dead_zone, self._expo)
        self.is_deflected = bool(shaped)
        self._rested = self._rested or not shaped
        self.is_inside = self.is_deflected and abs(deflection) < 1
        values.deflect(section, _limited((factor or 1.0) * shaped))

    def _given(self, low: float, high: float) -> float | None:
        if self._section.center is not None:
            return self._section.center
        if self._puck and min(low, high) < 0 < max(low, high):
            return 0.0
        return self._known


class Lever:
    """Where its axis is to be, as a share of the way between its soft limits.

    Until it has been moved it is where it was first seen; the axis follows only a change (see `Interlock.slid`), which
    the first throw of a switch is.
    """

    def __init__(self, section: ControlSection) -> None:
        self._section = section
        self._first: float | None = None
        self._moved = False

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, values: ControlValues) -> None:  # noqa: ARG002
        low, high = self._section.range or (sample.minimum, sample.maximum)
        if sample.null or low == high or self._section.axis is None:
            return
        position = share(sample.value, high, low) if self._section.invert else share(sample.value, low, high)
        self._first = position if self._first is None else self._first
        self._moved = self._moved or abs(position - self._first) >= MOVED
        values.positions[self._section.axis] = position if self._moved else self._first


class Wheel:
    """Moves its axis on by clicks or, by rate, deflects it by how fast they come."""

    def __init__(self, section: ControlSection, counter: bool) -> None:
        self._section, self._counter = section, counter
        self._steps = section.axis is not None and section.by != "rate"
        click = CLICK.get(section.axis, 0.01) if section.axis is not None and self._steps else CLICK_RATE
        self._coarse = section.coarse or click
        self._at: float | None = None  # where a running counter was
        self._recent: deque[tuple[float, float]] = deque()

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, values: ControlValues) -> None:
        clicks = [(change.time, self._clicks(change.sample)) for change in changes]
        if self._at is None and not sample.null:
            self._at = sample.value
        worth = (self._section.fine if fine else None) or self._coarse
        if self._steps and self._section.axis is not None:
            sign, click, axis = -1 if self._section.invert else 1, self._section.speed * worth, self._section.axis
            moved = sign * click * sum(count for _, count in clicks)
            values.steps[axis] = values.steps.get(axis, 0.0) + moved
            values.click[axis] = max(values.click.get(axis, 0.0), click if moved else 0.0)
            return
        self._recent.extend(clicks)
        while self._recent and self._recent[0][0] <= now - CLICKS_WITHIN:
            self._recent.popleft()
        rate = sum(count for _, count in self._recent) / CLICKS_WITHIN
        values.deflect(self._section, _limited(worth * rate))

    def _clicks(self, sample: Sample) -> float:
        if not self._counter:
            return sample.value if sample.relative else 0.0  # where a stick is, is no number of clicks
        if sample.null:  # whatever number comes with it is no place of the counter
            return 0.0
        before, self._at = self._at, sample.value
        if before is None:
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

    def read(self, sample: Sample, changes: Sequence[Change], now: float, fine: bool, values: ControlValues) -> None:  # noqa: ARG002
        if self._pressed is None:
            self._pressed = _pressed_before(changes) if changes else sample.pressed
        for change in changes:
            if change.sample.pressed != self._pressed:
                self._pressed = change.sample.pressed
                self._turned(change.time, values)
        if now - self._since >= HOLD and self._hold:
            values.presses.append(self._hold)
            self._since = math.inf

    def _turned(self, time: float, values: ControlValues) -> None:
        if self._pressed and self._hold:
            self._since = time
        elif self._pressed and self._press:
            values.presses.append(self._press)
        elif not self._pressed and self._press and self._since < math.inf:
            values.presses.append(self._hold if self._hold and time - self._since >= HOLD else self._press)
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
