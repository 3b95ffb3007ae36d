"""A start by OSC: a UDP packet with the right address, from a show controller, a phone or a script.

A thread of its own takes the packets, and what is no OSC is dropped there. It listens on this computer only, unless
another address of its own is given: whoever can reach the port can start the rig.
"""

from __future__ import annotations

import socket
from contextlib import ExitStack
from threading import Thread

from teleop.ports import DeviceError, UsageError

LOOK = 0.2  # s between looks at whether it is over


class OscTrigger:
    """Fires for a message to `address` whose first argument, if it has one, is not 0: a button that is let go sends 0.

    Raises UsageError without python-osc.
    """

    again = True

    def __init__(self, host: str, port: int, address: str) -> None:
        try:
            from pythonosc.osc_packet import OscPacket
        except ImportError:
            raise UsageError("--trigger osc: needs python-osc: pip install 'rs-teleop[osc]'") from None
        self._parse = OscPacket
        self._where, self._address = (host, port), address
        self._fired = self._over = False
        self.ignored = 0  # packets that were no OSC

    def open(self, stack: ExitStack) -> None:
        """Listen until the stack is left; raises DeviceError where that cannot be."""
        listener = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        try:
            listener.bind(self._where)
        except OSError as error:
            host, port = self._where
            raise DeviceError(f"--trigger osc: cannot listen on {host}:{port}: {error.strerror or error}") from None
        listener.settimeout(LOOK)
        thread = Thread(target=self._listen, args=(listener,), name="osc", daemon=True)
        thread.start()
        stack.callback(thread.join)
        stack.callback(setattr, self, "_over", True)

    def arm(self, now: float) -> None:  # noqa: ARG002 - what counts is what comes from now on
        self._fired = False

    def fired(self, now: float) -> bool:  # noqa: ARG002
        return self._fired

    def said(self, now: float) -> str:  # noqa: ARG002
        host, port = self._where
        return f"OSC {self._address} on {host}:{port}"

    def _listen(self, listener: socket.socket) -> None:
        while not self._over:
            try:
                data = listener.recv(65536)
            except TimeoutError:
                continue
            except OSError:  # an answer to nobody's packet, as some systems report it
                continue
            self._hear(data)

    def _hear(self, data: bytes) -> None:
        try:
            messages = [timed.message for timed in self._parse(data).messages]
            self._fired |= any(self._is_go(message.address, message.params) for message in messages)
        except Exception:  # noqa: BLE001 - whatever a stranger's packet does to a parser, it is a packet to ignore
            self.ignored += 1

    def _is_go(self, address: str, arguments: list[object]) -> bool:
        return address == self._address and (not arguments or bool(arguments[0]))
