"""What a controller's messages ask for: presses, positions of faders, clicks and sticks. Pure: times are given."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

from teleop.config.exchange.midi import Control, MidiControl, MidiSection, control, pressed
from teleop.core.axes import Axis, Limits
from teleop.exchange.midi.faders import LET_GO, Fader
from teleop.exchange.midi.messages import ACTIVE_SENSING, COARSE, FINE, LOWER, clicks, read
from teleop.exchange.midi.sprung import Sprung

PUSHED = 64  # of a controller's value, from which on a button is down
LOWER_BITS = 0.01  # s to wait for a fader's lower bits
JOG_TIME = 0.2  # s that the way of some clicks takes at least
MOST_SHARES = 256  # of a fader's way
MOST_JOG = 90.0  # units in one
STOP = {"do": "stop"}

Command = Mapping[str, Any]


class _Way:
    """Where a fader has been since it was last looked at, as shares of its way; it counts from `due` on."""

    def __init__(self) -> None:
        self.shares: deque[float] = deque(maxlen=MOST_SHARES)
        self.due = 0.0
        self._whole = True

    def add(self, share: float, due: float, whole: bool) -> None:
        """`whole` unless its lower bits are still to come, which replaces it."""
        if not self._whole:
            self.shares.pop()
        self.shares.append(share)
        self.due, self._whole = due, whole


class Surface:
    """`limits` are those of the rig's axes; a control of an axis that the rig has not does nothing."""

    def __init__(self, section: MidiSection, limits: Mapping[Axis, Limits]) -> None:
        own = [(control(each.sends), each) for each in section.controls]
        has = {axis.value for axis in limits}
        self.presses = {at: pressed(each.press) for at, each in own if each.press is not None}
        self._jogs = {at: each for at, each in own if each.jog in has}
        self._faders = {at: each for at, each in own if each.position in has}
        self._axes = {at: str(each.position) for at, each in self._faders.items()}
        self.faders = {at: _fader(each, limits) for at, each in self._faders.items()}
        self._sprung = {at: (str(each.speed), Sprung()) for at, each in own if each.speed in has}
        self._lower = {Control("cc", at.number + LOWER, at.channel): at for at in self.faders if at.kind == "cc14"}
        self._upper = {Control("cc", at.number, at.channel): at for at in self.faders if at.kind == "cc14"}
        self._stops = {at for at, command in self.presses.items() if command == STOP}
        self._down: set[Control] = set()
        self._ways: dict[Control, _Way] = {}  # of faders that were moved
        self._bits: dict[Control, int] = {}
        self._clicks: dict[str, float] = {}
        self._targets: dict[Control, float] = {}

    def stops(self, data: Sequence[int]) -> bool:
        """Whether a message is a STOP button's; for the thread that hears it, before any queue."""
        moved = read(data)
        return moved is not None and moved.control in self._stops and moved.value > 0

    def take(self, data: Sequence[int], now: float) -> Command | None:
        """A message that came at `now`: the command of a button that is pressed by it."""
        if len(data) == 1 and data[0] == ACTIVE_SENSING:
            for _, wheel in self._sprung.values():
                wheel.sensed(now)
            return None
        moved = read(data)
        if moved is None:
            return None
        at, value = moved
        if at in self.presses:
            return self._pressed(at, value)
        if at in self._jogs:
            each = self._jogs[at]
            self.turned(str(each.jog), clicks(value, each.clicks) * each.step)
        elif at in self._sprung:
            self._sprung[at][1].moved(value, now)
        else:
            self._faded(at, value, now)
        return None

    def _pressed(self, at: Control, value: int) -> Command | None:
        before = at in self._down
        down = value > 0 if at.kind == "note" else value >= PUSHED
        (self._down.add if down else self._down.discard)(at)
        return self.presses[at] if down and (at.kind == "note" or not before) else None

    def _faded(self, at: Control, value: int, now: float) -> None:
        if (fader := self._lower.get(at)) is not None:
            way = self._ways.setdefault(fader, _Way())
            way.add((self._bits.get(fader, 0) << 7 | value) / FINE, now, whole=True)
        elif (fader := self._upper.get(at)) is not None:
            self._bits[fader] = value
            self._ways.setdefault(fader, _Way()).add((value << 7) / FINE, now + LOWER_BITS, whole=False)
        elif at in self.faders:
            self._ways.setdefault(at, _Way()).add(value / (FINE if at.kind == "bend" else COARSE), now, whole=True)

    def goto(self, state: Mapping[str, Any], now: float, own: str) -> Command | None:
        """Where the faders that were moved send their axes, with the others that are on their way; None for nowhere.

        `own` is the session of this controller: no fader holds an axis while another one has control.
        """
        if state["stopped"] or state["move"] is not None or state["holder_session"] not in (None, own):
            self._let_go()
        changed = False
        for at, way in list(self._ways.items()):
            if way.due > now:
                continue
            del self._ways[at]
            here = state["axes"][self._axes[at]]["commanded"]
            target = None
            for share in way.shares:
                target = None if here is None else self.faders[at].moved(share, here, now)
            if target is not None:
                self._targets[at] = target
                changed = True
        if not changed:
            return None
        self._targets = {at: to for at, to in self._targets.items() if self._under_way(at, to, state, now)}
        return {"do": "goto", "axes": {self._axes[at]: to for at, to in self._targets.items()}}

    def _under_way(self, at: Control, to: float, state: Mapping[str, Any], now: float) -> bool:
        axis = state["axes"][self._axes[at]]
        return now - self.faders[at].moved_at <= LET_GO or bool(axis["speed"] or abs(axis["commanded"] - to) > 1e-3)

    def _let_go(self) -> None:
        self._targets.clear()
        for fader in self.faders.values():
            fader.let_go()

    def jogs(self) -> Mapping[str, Command]:
        """By the axis: the way of all clicks since the last time."""
        turned, self._clicks = self._clicks, {}
        return {axis: {"do": "jog", "axis": axis, "by": by, "within": JOG_TIME} for axis, by in turned.items() if by}

    def turned(self, axis: str, by: float) -> None:
        """Clicks that are to be passed on, by how far they move the axis."""
        self._clicks[axis] = min(max(self._clicks.get(axis, 0.0) + by, -MOST_JOG), MOST_JOG)

    def deflections(self, now: float) -> Mapping[str, float]:
        """Of each axis that a wheel with a spring moves, -1..1."""
        return {axis: wheel.deflection(now) for axis, wheel in self._sprung.values()}

    @property
    def late(self) -> bool:
        """Whether a wheel was held for longer than it was heard."""
        return any(wheel.late for _, wheel in self._sprung.values())

    def axis_of(self, at: Control) -> str:
        return self._axes[at]


def _fader(section: MidiControl, limits: Mapping[Axis, Limits]) -> Fader:
    return Fader.of(section.low, section.high, limits[Axis(str(section.position))])
