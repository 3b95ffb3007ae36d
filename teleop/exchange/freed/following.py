"""FreeD D1 in: where a tracker says that a camera is."""

from __future__ import annotations

from teleop.config.exchange.freed import FreeDSection
from teleop.exchange.following import Follower, Place, follow
from teleop.exchange.freed.codec import FreeDError, decode
from teleop.exchange.served import Served


async def receive(section: FreeDSection, listen: str, served: Served) -> None:
    """Follow one camera of what arrives, until cancelled."""
    await follow(section, listen, served, "freed", lambda name: FreeDFollower(section, served, name))


class FreeDFollower(Follower):
    def __init__(self, section: FreeDSection, served: Served, name: str) -> None:
        super().__init__(section, served, name, self._place)
        self._camera = section.camera

    def _place(self, data: bytes, host: str) -> Place | str | None:
        try:
            message, by_the_book = decode(data)
        except FreeDError as error:
            return str(error)
        if message.camera != self._camera:
            self.note(f"camera {message.camera} from {host} is not followed: the entry has camera {self._camera}", "id")
            return None
        if not by_the_book:
            self.note(
                f"{host} takes its checksum from 0x100, and not from 0x40; its messages are taken all the same", "sum"
            )
        return Place(message.x, message.y, message.z)
