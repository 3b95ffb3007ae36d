"""How a gimbal on the bench is brought to rest, whatever it was sent last."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from teleop.devices.gimbal.speed import BETWEEN_ZEROS, GIVE_BACKS, ZEROS
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message

if TYPE_CHECKING:
    from teleop.commission.gimbal.bench import GimbalBench

HALT = 0.1  # s for the command that ends a position
SETTLES = 2.0  # s at most until it rests


class Rest:
    """Remembers what is in force, and ends it: zero speed three times and control given back, the stick let go, a
    position ended where it is. Then it waits until the angles rest."""

    def __init__(self, bench: GimbalBench) -> None:
        self._bench = bench
        self._taken = self._pushed = False
        self._moving_until = -math.inf
        self._zeros = self._given_back = 0
        self._waiting = -1
        self._until: float | None = None

    def note(self, message: Message, now: float) -> None:
        """This is sent at `now`."""
        match message:
            case gimbal.Speed():
                self._taken = self._taken or message.take_over
            case gimbal.Joystick():
                self._pushed = True
            case gimbal.Position():
                self._moving_until = now + message.time_for_action
            case gimbal.Mode():
                self._moving_until = math.inf
            case _:
                return
        self._zeros = self._given_back = 0
        self._until = None

    def release(self, now: float) -> float | None:
        bench = self._bench
        if (self._taken or self._pushed) and self._zeros < ZEROS:
            self._zeros += 1
            if self._taken:
                bench.connection.request(gimbal.Speed(0.0, 0.0, 0.0, take_over=True, ignore_focal_length=True), now)
            if self._pushed:
                bench.connection.stream(gimbal.Joystick(pitch=0, roll=0, yaw=0))
            return now + BETWEEN_ZEROS
        self._pushed = False
        if self._taken:
            if self._given_back and (bench.code(self._waiting) is not None or self._given_back >= GIVE_BACKS):
                self._taken = False
            else:
                give_back = gimbal.Speed(0.0, 0.0, 0.0, take_over=False, ignore_focal_length=True)
                self._waiting = bench.connection.request(give_back, now)
                self._given_back += 1
                return now + BETWEEN_ZEROS
        if now < self._moving_until:
            self._moving_until = -math.inf
            bench.connection.request(gimbal.Position(0.0, 0.0, 0.0, False, time_for_action=HALT), now)
            return now + HALT
        return self._settle(now)

    def at_once(self, now: float) -> None:
        """All of it in one go."""
        connection = self._bench.connection
        if self._pushed:
            connection.stream(gimbal.Joystick(pitch=0, roll=0, yaw=0))
        if self._taken:
            connection.request(gimbal.Speed(0.0, 0.0, 0.0, take_over=False, ignore_focal_length=True), now)
        if now < self._moving_until:
            connection.request(gimbal.Position(0.0, 0.0, 0.0, False, time_for_action=HALT), now)

    def _settle(self, now: float) -> float | None:
        if self._until is None:
            self._until = now + SETTLES
            return now + BETWEEN_ZEROS
        if self._bench.quiet or self._bench.still or now >= self._until:
            return None
        return now + BETWEEN_ZEROS
