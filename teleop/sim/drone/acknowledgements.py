"""The acknowledgements of a simulated drone: which are on their way, and what was answered to which request.

A request that comes again byte for byte, because its acknowledgement was lost, is acknowledged by the same bytes and
not obeyed again. Only what comes again soon is a repetition: a client with constant sequence numbers may mean it anew.
"""

from __future__ import annotations

from typing import Final

from teleop.dji.drone.onboard_sdk import SESSION
from teleop.dji.frame import Frame

REPEATED_WITHIN: Final = 3.0  # s: the longest that a client sends again for, which is activation's 3 times 1 s


class Acknowledgements:
    """Each leaves `delay` s after it was given."""

    def __init__(self, delay: float) -> None:
        self._delay = delay
        self._leaving: list[tuple[float, bytes]] = []
        self._given: dict[int, tuple[float, Frame, bytes]] = {}  # by session: the last request, and its answer

    def to_repetition(self, request: Frame, now: float) -> bytes | None:
        """What was answered to the same request a moment ago."""
        time, before, answer = self._given.get(request.cmd_type & SESSION, (0.0, None, b""))
        return answer if before == request and now - time <= REPEATED_WITHIN else None

    def remember(self, request: Frame, answer: bytes, now: float) -> None:
        self._given[request.cmd_type & SESSION] = now, request, answer

    def give(self, answer: bytes, now: float) -> None:
        self._leaving.append((now + self._delay, answer))

    def due(self, now: float) -> bytes:
        """Those that leave up to `now`."""
        sent = b"".join(answer for time, answer in self._leaving if time <= now)
        self._leaving = [each for each in self._leaving if each[0] > now]
        return sent

    def forget(self) -> None:
        """The drone goes out."""
        self._leaving.clear()
        self._given.clear()
