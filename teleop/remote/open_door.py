"""The door of a run, open: its folder, ring and socket, and the gateway that is started for it."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack

from teleop.core.interfaces import Clock
from teleop.door.address import new_door
from teleop.door.ring import RingWriter
from teleop.door.sockets import CommandSocket
from teleop.remote.desk import Desk
from teleop.remote.gateway_child import Gateway, GatewayChild
from teleop.remote.state import Parts, StatePublisher

LISTENS = 1.0  # s without a tick, after which the gateway's silence says nothing: a shoot that waits for its rig


class OpenDoor:
    """Open until the stack is left."""

    def __init__(self, stack: ExitStack) -> None:
        self.address = stack.enter_context(new_door())
        self.ring = RingWriter(self.address.ring)
        stack.callback(self.ring.close)
        self.socket = CommandSocket(self.address.commands)
        stack.callback(self.socket.close)
        self._ended = False  # the gateway, since the last look

    def publisher(self, parts: Parts, clock: Clock) -> StatePublisher:
        """What writes the states of the run: that it waits, at once."""
        made = StatePublisher(parts, self.ring)
        made.publish("waiting", clock.now())
        return made

    def start(
        self, stack: ExitStack, gateway: Gateway, desk: Desk, clock: Clock, notify: Callable[[str], object]
    ) -> None:
        """Have the gateway run from now on."""

        def heard() -> float:
            """When the gateway was heard last, by the machine's clock; now, while this process does not listen."""
            now = clock.now()
            listens = now - desk.polled_at < LISTENS
            return time.monotonic() - (now - desk.gateway_at if listens else 0.0)

        settings = {**gateway.settings, "door": str(self.address.folder)}
        child = GatewayChild(settings, gateway.passed, heard, notify, self._end)
        stack.callback(child.close)
        child.start()

    def look(self, desk: Desk, now: float) -> None:
        """In the control thread, each tick: a gateway that has ended takes every connection with it."""
        if self._ended:
            self._ended = False
            desk.all_gone(now)

    def _end(self) -> None:
        self._ended = True
