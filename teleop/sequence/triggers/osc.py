"""A start by OSC: a UDP packet with the right address, from a show controller, a phone or a script.

A thread of its own takes the packets, and what is no OSC is dropped there. It listens on this computer only, unless
another address of its own is given: any program that reaches the port can start the rig.

A packet counts only for the arming in force when it was taken from the socket. Arming empties the socket first, so that
neither a packet that waits there nor one that the thread is still reading can start a move.
"""

from __future__ import annotations

import select
import socket
from contextlib import ExitStack, suppress
from threading import Event, Lock, Thread

from teleop.core.errors import DeviceError
from teleop.links.osc_packets import Argument, OscError, messages

POLL_PERIOD = 0.2  # s between looks at whether it is over
LEAVE = 1.0  # s for the listening thread to end
WAITING = 10_000  # packets that arming throws away at most: more than a socket holds
LONGEST = 65536  # bytes of a packet


class OscTrigger:
    """Fires for a message to `address` whose first argument, if it has one, is not 0, as of a button let go."""

    again = True

    def __init__(self, host: str, port: int, address: str) -> None:
        self._where, self._address = (host, port), address
        self._listener: socket.socket | None = None
        self._lock = Lock()  # over taking a packet, and over what it counts for
        self._armed = 0  # how often it was; a packet counts for the arming that it was taken in
        self._fired_in = 0  # the last arming in which a packet fired it
        self._over = Event()
        self.ignored = 0  # packets that were no OSC

    def open(self, stack: ExitStack) -> None:
        """Listen until the stack is left; raises DeviceError where that cannot be."""
        listener = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        try:
            listener.bind(self._where)
        except OSError as error:
            host, port = self._where
            raise DeviceError(f"--trigger osc: cannot listen on {host}:{port}: {error.strerror or error}") from None
        listener.setblocking(False)
        self._listener = listener
        thread = Thread(target=self._listen, args=(listener,), name="osc", daemon=True)
        thread.start()
        stack.callback(thread.join, LEAVE)
        stack.callback(self._over.set)

    def arm(self, now: float) -> None:  # noqa: ARG002 - the order of arrival decides, not a time
        with self._lock:
            self._armed += 1
            for _ in range(WAITING if self._listener else 0):
                if _taken(self._listener) is None:
                    return

    def fired(self, now: float) -> bool:  # noqa: ARG002
        return 0 < self._armed == self._fired_in

    def waits_for(self, now: float) -> str:  # noqa: ARG002
        host, port = self._where
        return f"OSC {self._address} on {host}:{port}"

    def _listen(self, listener: socket.socket) -> None:
        while not self._over.is_set():
            try:
                ready = bool(select.select([listener], [], [], POLL_PERIOD)[0])
            except (OSError, ValueError):  # the socket is gone
                ready = True
            with self._lock:
                data, armed = _taken(listener), self._armed
            if data is not None:
                self._hear(data, armed)
            elif ready:  # a socket that has nothing but an error is not asked again at once
                self._over.wait(POLL_PERIOD)

    def _hear(self, data: bytes, armed: int = 0) -> None:
        """A packet that was taken while it had been armed so many times."""
        try:
            if any(self._is_go(*message) for message in messages(data)):
                self._fired_in = armed
        except OscError:
            self.ignored += 1

    def _is_go(self, address: str, arguments: tuple[Argument, ...]) -> bool:
        return address == self._address and (not arguments or bool(arguments[0]))


def _taken(listener: socket.socket | None) -> bytes | None:
    """The next packet, None where none waits."""
    if listener is not None:
        with suppress(OSError):  # none waits, or an answer to no packet of ours, as some systems report it
            return listener.recv(LONGEST)
    return None
