"""Two ends of one cable in this process: what one sends the other receives, in order, at once."""

from __future__ import annotations

from collections import deque

from teleop.core.errors import LinkError


class MemoryLink:
    """One end of a cable; `pair` makes both. What had arrived before the far end closed can still be received."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._arrived: deque[bytes] = deque()
        self._closed = False
        self._far = self

    def send(self, data: bytes) -> None:
        """Raises LinkError when either end is closed."""
        if self._closed or self._far._closed:
            raise self._error()
        self._far._arrived.append(data)

    def receive(self) -> bytes:
        """Raises LinkError when this end is closed, or the far end is and nothing is left."""
        if self._closed:
            raise self._error()
        arrived = b"".join(self._arrived.popleft() for _ in range(len(self._arrived)))
        if not arrived and self._far._closed:
            raise self._error()
        return arrived

    def close(self) -> None:
        self._closed = True

    def _error(self) -> LinkError:
        return LinkError(f"memory: the {self._name if self._closed else self._far._name} end of the cable is closed")


def pair() -> tuple[MemoryLink, MemoryLink]:
    """Both ends of a new cable."""
    near, far = MemoryLink("near"), MemoryLink("far")
    near._far, far._far = far, near
    return near, far
