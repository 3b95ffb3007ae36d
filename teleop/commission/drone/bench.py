"""A drone on the bench, its propellers off: what it is asked, what it broadcasts, and how virtual RC is ended.

Everything that can be sent to it is a method of this class: three questions, and virtual RC on, off and with neutral
sticks. Arming, taking off, movement and any other stick have no way out of here.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import Any

from teleop.commission.step import Script
from teleop.devices.connection import Answer, Connection
from teleop.devices.drone.engagement import GAP, LAST_NEUTRALS
from teleop.devices.drone.last_enable import LastEnable
from teleop.devices.drone.telemetry import FRESH, SLOW_FRESH
from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import PARTS, Broadcast
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.enums import FlightStatus, Rate
from teleop.dji.drone.session import OnboardSession
from teleop.dji.drone.virtual_rc import NEUTRAL, VirtualRc
from teleop.dji.message import Message

RATES = drone.Frequency(
    time=Rate.OFF,
    quaternion=Rate.HZ_50,
    acceleration=Rate.OFF,
    velocity=Rate.HZ_50,
    angular_rate=Rate.HZ_50,
    position=Rate.HZ_10,
    magnetometer=Rate.OFF,
    rc=Rate.HZ_50,
    gimbal=Rate.HZ_10,
    status=Rate.HZ_50,
    battery=Rate.HZ_1,
    control=Rate.HZ_50,
)
"""What is asked for: 5 kB/s of the 23 that a serial line at 230400 baud has."""
PERIOD = 0.05  # s between two frames of neutral sticks: docs/protocol-facts.md
ENDS_ALONE = 1.5  # s without sticks after which virtual RC has ended by itself, whatever was lost


class DroneBench:
    """`open_link` opens the link, and closes the one before. `last` notes each enable of virtual RC for later runs."""

    def __init__(
        self,
        open_link: Callable[[], Connection],
        activation: drone.Activate,
        cipher: Cipher | None = None,
        last: LastEnable | None = None,
    ) -> None:
        self._open, self._activation, self._cipher, self._last = open_link, activation, cipher, last
        self.now = 0.0
        self.activated = False
        self.firmware = self.serial = ""
        self.counts: Counter[str] = Counter()  # parts of the broadcast that came
        self.answers: dict[int, Answer] = {}
        self._parts: dict[str, tuple[Any, float]] = {}
        self._enabled = -math.inf  # s: the last enable
        self._on = False  # enabled here, and not given back yet
        self._sticks_at = math.inf  # s: when the next neutral sticks are due; inf while none are sent
        self._last_sticks = -math.inf
        self._neutrals = 0
        self.reopen()

    # what the runner needs

    def poll(self, now: float) -> None:
        """Raises LinkError as the link does."""
        self.now = now
        self.connection.poll(now)
        if now >= self._sticks_at - 1e-6:
            self._send_neutral()

    def release(self, now: float) -> float | None:
        """Neutral sticks, then virtual RC off, once; nothing where it was not enabled here."""
        self.now = now
        if not self._on:
            return None
        self._sticks_at = math.inf
        if self._neutrals < LAST_NEUTRALS and now - self._last_sticks < ENDS_ALONE:
            self._neutrals += 1
            self._send_neutral(again=False)
            return now + PERIOD
        self.disable()
        return now + PERIOD

    def release_at_once(self) -> None:
        """One attempt, without waiting for anything."""
        if self._on:
            self.connection.stream(NEUTRAL)
            self.disable()

    def displaced(self) -> str:
        return ""  # nothing here moves

    def restore(self) -> Script:
        yield from ()
        return ()

    def reopen(self) -> None:
        self.connection = self._open()
        self._neutrals, self._sticks_at = LAST_NEUTRALS, math.inf  # the drone ends virtual RC while the link is lost
        if self.activated:
            self.use_cipher()  # the drone is the same, only the line was lost
        for request in (drone.Version, drone.Activate, drone.Frequency):
            self.connection.on_answer(request, self._answered)
        self.connection.on_push(Broadcast, self._keep)
        if self._last:
            self._enabled = max(self._enabled, self._last.read(self.connection.opened))

    @property
    def stands(self) -> bool:
        """Whether it reports that it stands by on the ground."""
        return self.get("status") == FlightStatus.STANDBY

    # what can be sent, all of it

    def ask_version(self) -> int:
        return self.connection.request(drone.Version(), self.now)

    def activate(self) -> int:
        return self.connection.request(self._activation, self.now)

    def set_rates(self) -> int:
        return self.connection.request(RATES, self.now)

    def enable(self) -> str:
        """Virtual RC on, back to the real RC when it ends, and neutral sticks 20 times a second from now on.

        What the operator has to know, "" for nothing. Only where `wait` is 0.
        """
        self._enabled, self._on, self._neutrals = self.now, True, 0
        trouble = self._last.write(self.now) if self._last else ""
        self.connection.stream(VirtualRc(on=True, back_to_rc=True))
        self._send_neutral()
        return trouble

    def fall_silent(self) -> None:
        """No more sticks: what ends virtual RC then is the drone."""
        self._sticks_at = math.inf

    def disable(self) -> None:
        """Virtual RC off; one disable for each enable."""
        self._sticks_at, self._on = math.inf, False
        self.connection.stream(VirtualRc(on=False, back_to_rc=True))

    @property
    def wait(self) -> float:
        """How long (s) virtual RC must not be enabled: twice within GAP locks the drone."""
        return max(0.0, self._enabled + GAP + PERIOD - self.now)

    @property
    def last_sticks(self) -> float:
        """When sticks were sent last (s)."""
        return self._last_sticks

    # what comes in

    def get(self, part: str, since: float = -math.inf) -> Any:
        """A part of the broadcast, None where it is too old to be believed or came before `since` (s)."""
        value, came = self._parts.get(part, (None, -math.inf))
        fresh = self.now - came <= (SLOW_FRESH if part == "battery" else FRESH)
        return value if fresh and came >= since else None

    def came(self, part: str) -> float:
        """When it came last (s)."""
        return self._parts.get(part, (None, -math.inf))[1]

    def reply(self, sequence: int) -> Message | None:
        answer = self.answers.get(sequence)
        return answer.reply if answer else None

    def use_cipher(self) -> None:
        """It is activated: from now on everything is encrypted, where the profile says so."""
        self.activated = True
        if isinstance(self.connection.session, OnboardSession):
            self.connection.session.cipher = self._cipher

    def _send_neutral(self, again: bool = True) -> None:
        self._last_sticks = self.now
        self._sticks_at = self.now + PERIOD if again else math.inf
        self.connection.stream(NEUTRAL)

    def _answered(self, answer: Answer) -> None:
        self.answers[answer.sequence] = answer

    def _keep(self, push: Message, now: float) -> None:
        for part in PARTS:
            value = getattr(push, part, None)
            if value is not None:
                self._parts[part] = value, now
                self.counts[part] += 1
