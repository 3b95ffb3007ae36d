"""Whether an input may move anything: what stands between a hand's device and the operator's rules.

An input begins untrusted, and is again after a trouble and after a STOP. It is trusted once it has been seen
centred: a stick that was held over while nobody listened moves nothing when somebody does. One with an enable button
then waits for that to be pressed, and pressed anew: a button that was held all along is a button that is stuck.
"""

from __future__ import annotations

from teleop.core.axes import Axis
from teleop.core.operator_input import Held, Input

CENTER = "center its sticks"
ENABLE = "hold its enable button"
OFF = "manual control is off"
JITTER = 0.002  # of a slider's way, which is no move: less than a step of eight bits, more than one of ten


class Interlock:
    """One input, and whether it is trusted: `said` is what it says, `waits_for` why it moves nothing, "" if it may."""

    def __init__(self, device: Input) -> None:
        self.said = Held()
        self.waits_for = CENTER
        self._device = device
        self._centred = self._enabled = self._fresh = False
        self._slid: dict[Axis, float] = {}  # where its sliders lay when they last were taken for moved

    @property
    def name(self) -> str:
        return self._device.name

    @property
    def trusted(self) -> bool:
        return not self.waits_for

    def read(self, now: float, hands_on: bool) -> Held:
        """What it says at `now`, and with it whether it is trusted; `hands_on` is the switch of those without a button.

        An input in trouble says nothing that is true, so then only its presses count: a stop is never too late.
        """
        self.said = self._device.read(now)
        if self.said.trouble:
            self.distrust()
            self.waits_for = self.said.trouble
            return self.said
        self._centred = self._centred or not any(self.said.deflections.values())
        self._enable()
        self.waits_for = self._missing(hands_on)
        return self.said

    def slid(self) -> dict[Axis, float]:
        """The sliders that were moved since the last time: one that only lies where it lay takes no axis there.

        While it is not trusted, moves are only followed, so that none is made up for later.
        """
        now, before = self.said.positions, self._slid
        moved = {axis: share for axis, share in now.items() if abs(share - before.get(axis, share)) > JITTER}
        self._slid = {axis: moved.get(axis, before.get(axis, share)) for axis, share in now.items()}
        return moved if self.trusted else {}

    def distrust(self) -> None:
        self._centred = self._enabled = self._fresh = False
        self.waits_for = CENTER

    def _enable(self) -> None:
        """Enabled while the button is held, if it was seen released after the input was seen centred."""
        held = self.said.enabled
        self._fresh = self._centred and (self._fresh or held is False)
        self._enabled = held is None or (held and self._fresh)

    def _missing(self, hands_on: bool) -> str:
        if not self._centred:
            return CENTER
        if not self._enabled:
            return ENABLE
        return "" if hands_on or self.said.enabled is not None else OFF
