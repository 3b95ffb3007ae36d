"""OSC over UDP: takes commands at `listen`, and sends feedback to `to`."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Collection
from contextlib import ExitStack, suppress
from time import monotonic
from typing import Any

from teleop.config.exchange.osc import OscSection
from teleop.core.axes import Axis
from teleop.exchange.client import Client, Peers
from teleop.exchange.osc.commands import ROOT, STOP, Invalid, command
from teleop.exchange.osc.feedback import Feedback
from teleop.exchange.served import Served
from teleop.exchange.udp import socket_for
from teleop.links.osc_packets import OscError, messages, packet

LOOK = 0.01  # s between two looks at the state
FADERS = (f"{ROOT}speed", f"{ROOT}goto/")  # of these only the newest counts
LONGEST = 160  # characters of an error


async def serve(section: OscSection, served: Served) -> None:
    """Serve until cancelled. Raises TeleopError where the receiver's host is unknown."""
    loop = asyncio.get_running_loop()
    with ExitStack() as stack:
        outlet = Outlet(await _receiver(section, stack))
        peers = Peers(served.door, "OSC", section.allow, outlet.error)
        inlet = Inlet(peers, served.rig.moved, outlet)
        if served.listener is not None:
            copy = served.listener.dup()  # the transport closes its own
            transport, _ = await loop.create_datagram_endpoint(lambda: inlet, sock=copy)
            stack.callback(transport.close)
        while True:
            outlet.send(served.door.state())
            await asyncio.sleep(LOOK)


async def _receiver(section: OscSection, stack: ExitStack) -> socket.socket | None:
    if section.to is None:
        return None
    sender, where = await socket_for(section.to)
    stack.callback(sender.close)
    sender.connect(where)
    return sender


class Outlet:
    """What goes to the receiver; nothing where there is none."""

    def __init__(self, sender: socket.socket | None) -> None:
        self._sender = sender
        self._feedback = Feedback()

    def send(self, state: dict[str, Any]) -> None:
        if self._sender is not None:
            for data in self._feedback.due(state, monotonic()):
                self._send(data)

    def again(self) -> None:
        self._feedback.again()

    def error(self, why: str) -> None:
        """Why a command was refused, or has ended before its end."""
        if self._feedback.measured:
            self._send(packet("/teleop/error", why[:LONGEST]))

    def _send(self, data: bytes) -> None:
        if self._sender is not None:
            with suppress(OSError):  # the receiver is not there, or its queue is full: the next one is as good
                self._sender.send(data)


class Inlet(asyncio.DatagramProtocol):
    """What arrives. `ignored` are packets that were no OSC."""

    def __init__(self, peers: Peers, axes: Collection[Axis], outlet: Outlet) -> None:
        self._peers, self._axes, self._outlet = peers, axes, outlet
        self.ignored = 0

    def datagram_received(self, data: bytes, addr: tuple[Any, ...]) -> None:
        try:
            found = messages(data)
        except OscError:
            self.ignored += 1
            return
        for message in found:
            if not message.address.startswith(ROOT):
                continue
            peer = self._peers.of(addr[0])
            try:
                asked = command(message, self._axes)
            except Invalid as why:
                self._outlet.error(str(why))
                continue
            if message.address == f"{ROOT}state":
                self._outlet.again()
            if asked is not None:
                _give(peer, message.address, asked)

    def error_received(self, exc: Exception) -> None: ...  # some systems report here what was sent to nobody


def _give(peer: Client, to: str, asked: Any) -> None:
    if asked is STOP:
        peer.stop()
    elif to.startswith(FADERS):
        peer.newest(asked, to)
    else:
        peer.post(asked)
