"""Whether an input may move anything.

An input begins locked, and is locked again by a fault and by a STOP. It is unlocked once its sticks were seen centered:
a stick that was deflected while it was locked moves nothing afterwards. One with an enable button then needs that to be
pressed anew: a button that was held all along is a button that is stuck.
"""

from __future__ import annotations

from teleop.core.axes import Axis
from teleop.core.operator_input import Held, Input

CENTER = "center its sticks"
ENABLE = "hold its enable button"
OFF = "manual control is off"
JITTER = 0.002  # of a slider's way, which is no move: less than a step of eight bits, more than one of ten


class Interlock:
    """An input and its lock: `held` is its last reading, `waits_for` why it moves nothing, "" when it is unlocked."""

    def __init__(self, device: Input) -> None:
        self.held = Held()
        self.waits_for = CENTER
        self._device = device
        self._centered = self._enabled = self._fresh = False
        self._slid: dict[Axis, float] = {}  # where its sliders lay when they last were taken for moved

    @property
    def name(self) -> str:
        return self._device.name

    @property
    def unlocked(self) -> bool:
        return not self.waits_for

    def read(self, now: float, manual_control: bool) -> Held:
        """Read the device at `now`; `manual_control` is the switch of inputs without an enable button.

        Of an input in trouble only the presses count, because nothing else is true then: a stop is never too late.
        """
        self.held = self._device.read(now)
        if self.held.trouble:
            self.relock()
            self.waits_for = self.held.trouble
            return self.held
        self._centered = self._centered or not (self.held.deflected or any(self.held.deflections.values()))
        self._enable()
        self.waits_for = self.held.late or self._missing(manual_control)
        return self.held

    def slid(self) -> dict[Axis, float]:
        """The sliders that were moved since the last time: one that only lies where it lay takes no axis there.

        While it is locked, moves are only followed, so that none is made up for later.
        """
        now, before = self.held.positions, self._slid
        moved = {axis: share for axis, share in now.items() if abs(share - before.get(axis, share)) > JITTER}
        self._slid = {axis: moved.get(axis, before.get(axis, share)) for axis, share in now.items()}
        return moved if self.unlocked else {}

    def relock(self) -> None:
        self._centered = self._enabled = self._fresh = False
        self.waits_for = CENTER

    def _enable(self) -> None:
        """Enabled while the button is held, if it was seen released after the input was seen centered."""
        held = self.held.enabled
        self._fresh = self._centered and (self._fresh or held is False)
        self._enabled = held is None or (held and self._fresh)

    def _missing(self, manual_control: bool) -> str:
        if not self._centered:
            return CENTER
        if not self._enabled:
            return ENABLE
        return "" if manual_control or self.held.enabled is not None else OFF
