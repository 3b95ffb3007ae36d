"""What a tracker reports, as the pan and tilt with which the camera would look at its target: a stream for the door.

It moves nothing by itself: a client with control asks for it by `track`, and the control process does the rest.
"""

from __future__ import annotations

import asyncio
import math
import socket
import struct
from collections.abc import Callable
from time import monotonic
from typing import NamedTuple

from teleop.config.exchange.address import address, is_allowed
from teleop.config.exchange.tracking import TrackingSection
from teleop.core.errors import TeleopError
from teleop.door.messages import CommandError
from teleop.exchange.served import Served
from teleop.planner.aim import AimError, Point, look_at

FASTEST = 0.008  # s between two messages that are passed on, at least
GONE = 1.0  # s of silence after which another sender may take a sender's place
NOTES = 12  # kinds of a line that are told, once each
ANY = "0.0.0.0"


class Place(NamedTuple):
    """Where a tracker says that something is, in m: x right, y forward, z up."""

    x: float
    y: float
    z: float


Read = Callable[[bytes, str], Place | str | None]
"""Of a datagram and its sender: the place in it, why it has none, or None for nothing to say of it."""


class Aimer:
    """From a place to pan and tilt, as the entry has it."""

    def __init__(self, section: TrackingSection) -> None:
        self._section = section

    def angles(self, place: Place) -> tuple[float, float]:
        """Pan and tilt in deg. Raises AimError where the target is at the camera."""
        section = self._section
        if section.as_ == "base":
            camera, target = Point(place.x, place.y, place.z + section.mount), Point(*(section.target or (0, 0, 0)))
        else:
            camera, target = Point(*section.position), Point(*place)
        pan, tilt = look_at(target, camera)
        return pan + section.offset.pan, tilt + section.offset.tilt


class Follower(asyncio.DatagramProtocol):
    """Passes on what one sender reports, the first that is allowed; tells once what it does not take."""

    def __init__(self, section: TrackingSection, served: Served, name: str, read: Read) -> None:
        self._section, self._served, self._name, self._read = section, served, name, read
        self._aimer = Aimer(section)
        self._peer, self._at = "", -math.inf
        self._notes: set[str] = set()

    def datagram_received(self, data: bytes, addr: tuple[str, int]) -> None:
        host, now = addr[0], monotonic()
        if not is_allowed(host, self._section.allow):
            self.note(f"messages from {host} move nothing: add it to allow", "allow")
            return
        if self._peer not in ("", host) and now - self._at < GONE:
            self.note(f"{host} sends too, but {self._peer} is followed", "peer")
            return
        found = self._read(data, host)
        if isinstance(found, str):
            self.note(f"a message from {host} {found}", found)
        elif found is not None and now - self._at >= FASTEST:
            self._peer, self._at = host, now
            self._pass(found, now)

    def _pass(self, place: Place, now: float) -> None:
        try:
            pan, tilt = self._aimer.angles(place)
            self._served.door.aim(self._served.tracker, {"pan": pan, "tilt": tilt}, now)
        except (AimError, CommandError) as error:
            self.note(f"cannot be aimed at: {error}", "aim")

    def note(self, text: str, kind: str) -> None:
        """A line for the operator, once for its kind."""
        if kind not in self._notes and len(self._notes) < NOTES:
            self._notes.add(kind)
            self._served.notify(f"{self._name}: {text}")


async def follow(
    section: TrackingSection,
    listen: str,
    served: Served,
    kind: str,
    follower: Callable[[str], Follower],
    interface: str | None = None,
) -> None:
    """Listen until cancelled. Raises OSError where a multicast group cannot be joined, TeleopError without a socket."""
    if served.listener is None:
        raise TeleopError(f"listen {listen}: is not open")
    name = f"{kind} at {listen}"
    listener = served.listener.dup()
    try:
        join(listener, listen, interface)
        listener.setblocking(False)
        transport, _ = await asyncio.get_running_loop().create_datagram_endpoint(lambda: follower(name), sock=listener)
    except BaseException:
        listener.close()
        raise
    what = "the target" if section.as_ == "target" else "the base"
    served.notify(
        f"{name}: tracking source {served.tracker}: {what} of an aim; it is followed once a client with control asks"
    )
    try:
        await asyncio.Event().wait()
    finally:
        transport.close()


def join(listener: socket.socket, listen: str, interface: str | None) -> None:
    """Become a member of the group, where it is one. Raises OSError."""
    place = address(listen)
    if not place.is_group:
        return
    if listener.family == socket.AF_INET6:
        member = socket.inet_pton(socket.AF_INET6, place.host) + struct.pack("@I", 0)
        listener.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_JOIN_GROUP, member)
        return
    member = socket.inet_aton(place.host) + socket.inet_aton(interface or ANY)
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
