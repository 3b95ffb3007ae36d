"""A drone held by the virtual RC: sticks and switches as channels, from a neutral that is P mode with the gear down.

The gesture that starts the motors is made for a bounded time, frame by frame, while the drone says that it stands by
and no stick is touched: in the air the same sticks would cut the motors (docs/protocol-facts.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from teleop.dji.drone_words import GearChannel, ModeChannel
from teleop.dji.virtual_rc import CENTRE, DEFLECTION, NEUTRAL, Sticks, VirtualRc
from teleop.motion import STICKS
from teleop.sinks.connection import Connection
from teleop.sinks.grips import ARMING, Deflections, not_in_standby
from teleop.sinks.telemetry import Telemetry

BACK_ALONE = "the drone goes back to its RC by itself, a second after the last sticks that it heard"
LOST_ALONE = "a second after the last sticks that it heard, the drone behaves as without any RC"
GESTURE = 2.0  # s for which the arm gesture is made, at most
CORNERS: Deflections = dict(zip(STICKS, (-1.0, -1.0, -1.0, 1.0), strict=True))
"""The gesture that starts and stops the motors, and in the air cuts them: Virtual RC page, Example."""


class VirtualRcGrip:
    """The virtual RC: sticks, and the switches as an operator sets them. Neutral is P mode, gear down."""

    what, period = "virtual RC", 0.05

    def __init__(self, connection: Connection, back_to_rc: bool, go_home: int | None) -> None:
        self._connection, self._back_to_rc, self._go_home = connection, back_to_rc, go_home
        self.say: Callable[[str], object] = lambda _text: None
        self._switches = NEUTRAL
        self._gesture_end = -math.inf
        self.alone = BACK_ALONE if back_to_rc else LOST_ALONE
        self._words = {
            **{f"mode-{mode.name.lower()}": {"mode": mode} for mode in ModeChannel},
            **{f"gear-{gear.name.lower()}": {"gear": gear} for gear in GearChannel},
            "home-off": {"go_home": CENTRE},
        }
        if go_home is not None:
            self._words["home"] = {"go_home": go_home}

    def refusals(self, seen: Telemetry, now: float) -> Iterator[str]:  # noqa: ARG002 - those of every taking will do
        return iter(())

    def warnings(self, seen: Telemetry, now: float) -> Iterator[str]:
        if seen.get("control", now) is None:
            yield "the drone sends no control field: whether virtual RC is on will not be known"
        if not self._back_to_rc:
            yield "when virtual RC ends the drone will behave as without any RC (back_to_rc: false)"

    def take(self, seen: Telemetry, now: float) -> None:  # noqa: ARG002 - whatever it says
        self._switches, self._gesture_end = NEUTRAL, -math.inf
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

    def withdraw(self) -> None:
        """Nothing here is ever sent again."""

    def give_back(self, now: float) -> None:  # noqa: ARG002 - whenever it is
        self._connection.stream(VirtualRc(on=False, back_to_rc=self._back_to_rc))

    def held(self, seen: Telemetry, now: float) -> bool | None:
        control = seen.get("control", now)
        return None if control is None else control.virtual_rc

    def tell(self, word: str, seen: Telemetry, now: float) -> str:
        if word == "home" and self._go_home is None:
            return "go home: the profile does not say what its channel is to be (go_home)"
        if word in ARMING:
            if refusal := not_in_standby(seen, now):
                return f"{word} refused: {refusal}; in the air this would cut the motors"
            self._gesture_end = now + GESTURE
            return f"{word}: sticks in the corners for {GESTURE:g} s, while the drone says standby"
        self._switches = _replaced(self._switches, **self._words[word])
        return f"{word}: set"


def _with(switches: Sticks, sticks: Deflections) -> Sticks:
    roll, pitch, throttle, yaw = (CENTRE + round(DEFLECTION * max(-1.0, min(1.0, sticks[axis]))) for axis in STICKS)
    return _replaced(switches, roll=roll, pitch=pitch, throttle=throttle, yaw=yaw)


def _replaced(sticks: Sticks, **channels: int) -> Sticks:
    return Sticks(**{**{spec.name: getattr(sticks, spec.name) for spec in Sticks.layout.fields}, **channels})
