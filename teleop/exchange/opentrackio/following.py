"""OpenTrackIO in: where a tracker says that a camera is."""

from __future__ import annotations

from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.exchange.following import Follower, Place, follow
from teleop.exchange.opentrackio.packets import PacketError, Reassembly, parsed
from teleop.exchange.opentrackio.sample import SampleError, received
from teleop.exchange.served import Served


async def receive(section: OpenTrackIOSection, listen: str, served: Served) -> None:
    """Follow one source of what arrives, until cancelled."""
    make = lambda name: OpenTrackIOFollower(section, served, name)  # noqa: E731
    await follow(section, listen, served, "opentrackio", make, section.interface)


class OpenTrackIOFollower(Follower):
    def __init__(self, section: OpenTrackIOSection, served: Served, name: str) -> None:
        super().__init__(section, served, name, self._place)
        self._source = section.source
        self._joined = Reassembly()

    def _place(self, data: bytes, host: str) -> Place | str | None:
        try:
            packet = parsed(data)
            whole = self._joined.add(host, packet)
            found = None if whole is None else received(whole, packet.encoding)
        except (PacketError, SampleError) as error:
            return str(error)
        if not packet.by_the_book:
            self.note(f"{host} makes its checksum modulo 255; its packets are taken all the same", "sum")
        if found is None:
            return None
        if found.number != self._source:
            self.note(f"source {found.number} from {host} is not followed: the entry has source {self._source}", "id")
            return None
        return Place(found.pose.x, found.pose.y, found.pose.z)
