"""A drone held by the virtual RC: sticks and switches as channels, from a neutral that is P mode with the gear down.

The gesture that starts the motors is made for a bounded time, frame by frame, while the drone says that it stands by
and no stick is touched: in the air the same sticks would cut the motors (docs/protocol-facts.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from teleop.core.axes import STICKS
from teleop.devices.connection import Connection
from teleop.devices.drone.control_mode import ARMING, Deflections, not_in_standby
from teleop.devices.drone.engagement import CONFIRM, GAP
from teleop.devices.drone.last_enable import LastEnable
from teleop.devices.drone.telemetry import FRESH, Telemetry
from teleop.dji.drone.enums import GearChannel, ModeChannel
from teleop.dji.drone.virtual_rc import CENTER, DEFLECTION, NEUTRAL, Sticks, VirtualRc

BACK_ALONE = "the drone goes back to its RC by itself, 1 s after the last sticks that reached it"
LOST_ALONE = "1 s after the last sticks that reached it, the drone behaves as without any RC"
GESTURE = 2.0  # s for which the arm gesture is made, at most
CORNERS: Deflections = dict(zip(STICKS, (-1.0, -1.0, -1.0, 1.0), strict=True))
"""The gesture that starts and stops the motors, and in the air cuts them: Virtual RC page, Example."""


class VirtualRcControl:
    """The virtual RC: sticks, and the switches as an operator sets them. Neutral is P mode, gear down.

    `last` is where its enables are noted for the next run; a simulated drone, which ends with this one, needs none.
    """

    what, period, gap, patience = "virtual RC", 0.05, GAP, CONFIRM
    repeats = False  # one disable for each enable; the drone leaves virtual RC by itself after 1 s without sticks

    def __init__(
        self, connection: Connection, back_to_rc: bool, go_home: int | None, last: LastEnable | None = None
    ) -> None:
        self._connection, self._back_to_rc, self._go_home = connection, back_to_rc, go_home
        self.notify: Callable[[str], object] = lambda _text: None
        self._last = last
        self.taken = last.read(connection.opened) if last else -math.inf
        self._switches = NEUTRAL
        self._gesture_end = -math.inf
        self._changed = math.inf  # s: when it was last taken or given back
        self._mine = self._returned = False  # whether the last enable is its own, and has been given back
        self._foreign = -math.inf  # s: at the latest, another's enable
        self.alone = BACK_ALONE if back_to_rc else LOST_ALONE
        self._words = {
            **{f"mode-{mode.name.lower()}": {"mode": mode} for mode in ModeChannel},
            **{f"gear-{gear.name.lower()}": {"gear": gear} for gear in GearChannel},
            "home-off": {"go_home": CENTER},
        }
        if go_home is not None:
            self._words["home"] = {"go_home": go_home}

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:
        control = seen.get("control", now)
        if control is not None and control.virtual_rc:
            yield "virtual RC is on already, for another program or an earlier run: wait until it ends"
        elif (left := self._foreign + GAP - now) > 0:
            yield f"wait {math.ceil(left * 10) / 10:.1f} s: an earlier run or another program enabled virtual RC"

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]:
        if seen.get("control", now) is None:
            yield "the drone sends no control field: whether virtual RC is on will not be known"
        if not self._back_to_rc:
            yield "when virtual RC ends the drone will behave as without any RC (back_to_rc: false)"

    def take(self, seen: Telemetry, now: float) -> None:  # noqa: ARG002 - whatever it says
        self._switches, self._gesture_end = NEUTRAL, -math.inf
        self._changed, self._mine, self._returned = now, True, False
        if self._last and (trouble := self._last.write(now)):
            self.notify(trouble)
        self._connection.stream(VirtualRc(on=True, back_to_rc=self._back_to_rc))

    def drive(self, sticks: Deflections, seen: Telemetry, now: float) -> None:
        if now < self._gesture_end:
            if not not_in_standby(seen, now) and not any(sticks.values()):
                self._connection.stream(_with(self._switches, CORNERS))
                return
            self._gesture_end = -math.inf
        self._connection.stream(_with(self._switches, sticks))

    def neutral(self, seen: Telemetry, now: float) -> None:  # noqa: ARG002 - whatever it says
        self._switches, self._gesture_end = NEUTRAL, -math.inf
        self._connection.stream(NEUTRAL)

    def watch(self, seen: Telemetry, now: float) -> None:
        """See whether another has enabled it: that it was on before it was taken here."""
        control = seen.get("control", now)
        if control is None or self._mine:
            return
        if control.virtual_rc and now - self._foreign >= GAP:
            self._foreign = now

    def withdraw(self) -> None:
        """Nothing here is ever sent again."""

    def give_back(self, now: float) -> None:
        self._changed, self._returned = now, True
        self._connection.stream(VirtualRc(on=False, back_to_rc=self._back_to_rc))

    def give_back_again(self, now: float) -> None:
        """One disable for each enable: docs/protocol-facts.md."""

    def contradicted(self, seen: Telemetry, now: float) -> bool:  # noqa: ARG002 - there is nothing to send again
        return False

    def held(self, seen: Telemetry, now: float) -> bool | None:
        """By the bit, as far as it came after the last enable or disable: an older one says nothing of that."""
        control = seen.get("control", now, min(FRESH, now - self._changed))
        if control is None:
            return None
        self._mine &= control.virtual_rc or not self._returned
        return control.virtual_rc

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        if word == "home" and self._go_home is None:
            return "go home: the profile has no channel value for it (go_home)"
        if word in ARMING:
            if refusal := not_in_standby(seen, now):
                return f"{word} refused: {refusal}; in the air this would cut the motors"
            self._gesture_end = now + GESTURE
            return f"{word}: sticks in the corners for {GESTURE:g} s, while the drone reports standby"
        self._switches = _replaced(self._switches, **self._words[word])
        return f"{word}: set"


def _with(switches: Sticks, sticks: Deflections) -> Sticks:
    roll, pitch, throttle, yaw = (CENTER + round(DEFLECTION * max(-1.0, min(1.0, sticks[axis]))) for axis in STICKS)
    return _replaced(switches, roll=roll, pitch=pitch, throttle=throttle, yaw=yaw)


def _replaced(sticks: Sticks, **channels: int) -> Sticks:
    return Sticks(**{**{spec.name: getattr(sticks, spec.name) for spec in Sticks.layout.fields}, **channels})
