"""What a server of an exchange entry is given, in a test: a door whose state the test sets, and what was told."""

from __future__ import annotations

import socket
from collections.abc import Mapping
from time import monotonic
from typing import Any, cast

from teleop.core.axes import Axis, Limits, Reading
from teleop.exchange.served import Rig, Served
from teleop.gateway.door_client import DoorClient

LIMITS = {axis: Limits(-180.0, 180.0, 60.0, 240.0, 2400.0) for axis in (Axis.PAN, Axis.TILT)}


class FakeDoor:
    """`aims` are what followers have passed on, `beside` readings of axes that the run does not move."""

    def __init__(self) -> None:
        self.state: Mapping[str, Any] = {}
        self.beside: dict[Axis, Reading] = {}
        self.aims: list[tuple[int, dict[str, float], float]] = []

    def newest(self) -> Mapping[str, Any]:
        return self.state

    def readings(self) -> Mapping[Axis, Reading]:
        return self.beside

    def aim(self, source: int, axes: dict[str, float], time: float) -> None:
        self.aims.append((source, axes, time))

    def measure(self, age: float = 0.0, **axes: float) -> None:
        """A state with readings that are so old (s)."""
        rows = {axis: {"measured": at, "measured_age_ms": age * 1000} for axis, at in axes.items()}
        self.state = {"time": monotonic(), "axes": rows, "stopped": False}


class FakeServed:
    """`lines` are those for the operator."""

    def __init__(self, limits: Mapping[Axis, Limits] = LIMITS, listener: socket.socket | None = None) -> None:
        self.door, self.lines = FakeDoor(), list[str]()
        self.served = Served(cast(DoorClient, self.door), Rig("rig", limits, limits), listener, self.lines.append, 1)
