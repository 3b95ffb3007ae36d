"""A capture of one's own link, in both directions: all of a bus, and of a simulated gimbal its frames as on a bus."""

from __future__ import annotations

from collections import Counter

from teleop.captures.captured import FROM_DEVICE, TO_DEVICE, Source
from teleop.captures.recording import Recording
from teleop.core.interfaces import Link
from teleop.dji.frame import pieces
from teleop.links.can import GIMBAL_ID, HOST_ID, BusFrame, CanLink

_IDS = {TO_DEVICE: HOST_ID, FROM_DEVICE: GIMBAL_ID}


def tap(link: Link, recording: Recording, source: Source) -> Link:
    """A link to be used in the place of `link`, of which `recording` hears all that passes."""
    if isinstance(link, CanLink):
        link.tap = recording.hear
        return link
    if source.kind == "serial":
        from teleop.links.serial import SerialLink  # pyserial, where a serial line is

        if isinstance(link, SerialLink):
            link.tap = recording.hear_from
            return link
    return TappedLink(link, recording, source)


class TappedLink:
    """A `Link` to a simulated device; `foreign` counts the frames of others, as on a bus."""

    def __init__(self, link: Link, recording: Recording, source: Source) -> None:
        self._link, self._recording, self._in_pieces = link, recording, source.kind == "can"
        foreign = getattr(link, "foreign", None)
        self.foreign: Counter[int] = Counter() if foreign is None else foreign

    def send(self, data: bytes) -> None:
        self._link.send(data)
        self._hear(TO_DEVICE, data)

    def receive(self) -> bytes:
        data = self._link.receive()
        if data:
            self._hear(FROM_DEVICE, data)
        return data

    def _hear(self, sender: int, data: bytes) -> None:
        if not self._in_pieces:
            self._recording.hear_from(sender, data)
            return
        for piece in pieces(data):
            self._recording.hear(BusFrame(_IDS[sender], piece))
