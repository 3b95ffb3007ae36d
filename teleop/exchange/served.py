"""What a server of an exchange entry is given: the door, the rig, and the socket that was opened for it."""

from __future__ import annotations

import socket
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from teleop.core.axes import Axis, Limits
from teleop.gateway.door_client import DoorClient


@dataclass(frozen=True)
class Rig:
    """The rig as the run knows it: its name, and what each axis may do in this run.

    `moved` are those that the run moves: a move has none but its own, and a device that is absent takes its axes out.
    """

    name: str
    limits: Mapping[Axis, Limits]
    moved: Mapping[Axis, Limits]


@dataclass(frozen=True)
class Served:
    """`listener` is bound to the entry's `listen` already, non-blocking; None for an entry without one.

    `notify` passes a line on to the operator. `tracker` is the number, from 1, of an entry that tracks.
    """

    door: DoorClient
    rig: Rig
    listener: socket.socket | None
    notify: Callable[[str], None]
    tracker: int = 0
