"""What a simulated gimbal has still to send: pushes at once, replies when their time has come."""

from __future__ import annotations

from collections import deque


class Outgoing:
    """Replies are sent `reply_delay` s after their request."""

    def __init__(self, reply_delay: float) -> None:
        self._reply_delay = reply_delay
        self._due = bytearray()
        self._late: deque[tuple[float, bytes]] = deque()  # when to send it (s), and what

    def push(self, data: bytes) -> None:
        self._due += data

    def reply(self, data: bytes, now: float) -> None:
        if self._reply_delay:
            self._late.append((now + self._reply_delay, data))
        else:
            self._due += data

    def taken(self, now: float) -> bytes:
        """What is sent by `now`, once."""
        while self._late and self._late[0][0] <= now:
            self._due += self._late.popleft()[1]
        sent = bytes(self._due)
        self._due.clear()
        return sent

    def clear(self) -> None:
        self._due.clear()
        self._late.clear()
