"""Looks at what passes between a rig and its simulated gimbal, and cuts it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

from teleop.devices.rig import Rig
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message
from teleop.sim.gimbal.device import SimulatedGimbal

Kind = TypeVar("Kind", bound=Message)


@dataclass
class Tap:
    """Every message to the gimbal, with its time; from `deaf_from` on it hears nothing, from `mute_from` it is mute."""

    gimbal: SimulatedGimbal
    heard: list[tuple[float, Message]] = field(default_factory=list)
    deaf_from: float = float("inf")
    mute_from: float = float("inf")

    def of(self, kind: type[Kind]) -> list[tuple[float, Kind]]:
        return [(time, message) for time, message in self.heard if isinstance(message, kind)]


def tapped(rig: Rig) -> Tap:
    """A tap on the rig's only simulated gimbal."""
    [gimbal] = rig.simulated.values()
    tap, session = Tap(gimbal), Session()
    receive, advance = gimbal.receive, gimbal.advance

    def listen(data: bytes, now: float) -> None:
        if now < tap.deaf_from:
            tap.heard += [(now, received.message) for received in session.receive(data, now)]
            receive(data, now)

    def speak(now: float) -> bytes:
        said = advance(now)
        return said if now < tap.mute_from else b""

    gimbal.receive, gimbal.advance = listen, speak
    return tap
