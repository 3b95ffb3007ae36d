"""What the drone says of itself, from the first question to it on: the connection brought up, then its broadcast kept.

A real M100 broadcasts, and takes 00 10, before it is activated (OSDK issue 145); others may not, so nothing here
depends on it. Its control field, in which the virtual-RC bit is, comes only when asked for (docs/protocol-facts.md).
So a connection is brought up by a short list of requests, each sent when the one before was acknowledged; what the
drone refuses or leaves unanswered ends the run, in words. From then on every part of the broadcast is kept with the
time it came: an old value is not a value.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import IntEnum
from typing import Any

from teleop.core.errors import DeviceError, LinkError
from teleop.devices.connection import Answer, Connection
from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import PARTS, Broadcast
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.enums import Code, Rate
from teleop.dji.drone.session import OnboardSession
from teleop.dji.message import Message

RATES = drone.Frequency(
    time=Rate.OFF,
    quaternion=Rate.HZ_50,
    acceleration=Rate.OFF,
    velocity=Rate.HZ_10,
    angular_rate=Rate.OFF,
    position=Rate.HZ_10,
    magnetometer=Rate.OFF,
    rc=Rate.HZ_10,
    gimbal=Rate.HZ_10,
    status=Rate.HZ_50,
    battery=Rate.HZ_1,
    control=Rate.HZ_50,
)
"""What is asked for: 2 kB/s of the 23 that a serial line at 230400 baud has. Status and control decide over safety."""

FRESH = 1.0  # s for which a part of the broadcast is believed
SLOW_FRESH = 3.0  # s, of one that comes once a second


class Telemetry:
    """`activation` is the message that activates the drone; with `cipher` all that follows it is encrypted."""

    def __init__(self, connection: Connection, activation: drone.Activate, cipher: Cipher | None = None) -> None:
        self._connection, self._cipher = connection, cipher
        self._steps: Sequence[Message] = (drone.Version(), activation, RATES)
        self._step = 0
        self._asked = False
        self._fault: DeviceError | LinkError | None = None
        self._parts: dict[str, tuple[Any, float]] = {}
        self.control_lost = 0  # how often the drone reported it
        for kind in (drone.Version, drone.Activate, drone.Frequency):
            connection.on_answer(kind, self._answered)
        connection.on_push(Broadcast, self._keep)
        connection.on_push(drone.Pushed, self._pushed)

    def service(self, now: float) -> None:
        """Take in what has come, and go on with bringing up. Raises DeviceError and LinkError, once for each fault."""
        self._connection.poll(now)
        if self._fault:
            fault, self._fault = self._fault, None
            raise fault
        if self._step < len(self._steps) and not self._asked:
            self._asked = True
            self._connection.request(self._steps[self._step], now)

    @property
    def activated(self) -> bool:
        return self._step >= len(self._steps)

    def get(self, part: str, now: float, within: float = FRESH) -> Any:
        """A part of the broadcast, None where it has not come `within` so many s and is too old to be believed."""
        value, since = self._parts.get(part, (None, -math.inf))
        return value if now - since <= (SLOW_FRESH if part == "battery" else within) else None

    def _answered(self, answer: Answer) -> None:
        if answer.reply is None:
            name = ("", " when asked to activate it", " when it is asked for its broadcast")[self._step]
            self._fault = LinkError(f"{self._connection} does not answer{name}: is it on, is the cable in?")
        elif code := getattr(answer.reply, "code", None):
            if self._step == 0 and code == Code.NOT_ACTIVATED:
                self._step, self._asked = 1, False
                return
            words = code.name.lower().replace("_", " ") if isinstance(code, IntEnum) else f"{code:#x}"
            verb = ("answered", "refuses to be activated", "refuses to broadcast")[self._step]
            self._fault = DeviceError(f"the drone {verb}: {words}")
        else:
            self._step, self._asked = self._step + 1, False
            if self._step == 2 and isinstance(self._connection.session, OnboardSession):  # activated
                self._connection.session.cipher = self._cipher

    def _keep(self, push: Message, now: float) -> None:
        for part in PARTS:
            value = getattr(push, part, None)
            if value is not None:
                self._parts[part] = value, now

    def _pushed(self, _push: Message, _now: float) -> None:
        self.control_lost += 1
