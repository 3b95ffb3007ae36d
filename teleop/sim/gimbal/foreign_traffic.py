"""The traffic of a real gimbal's own on a CAN bus: DJI's internal protocol on other ids (docs/protocol-facts.md)."""

from __future__ import annotations

from typing import Final

IDS: Final = 0x530, 0x531, 0x426
FRAMES_PER_SECOND: Final = 400.0  # frames/s, on all of them
_MOST: Final = 40  # frames at once, after a pause of any length


class ForeignTraffic:
    """Counts frames out from `now` (s) on."""

    def __init__(self, now: float) -> None:
        self._start, self._sent = now, 0

    def due(self, now: float) -> list[tuple[int, bytes]]:
        """The id and data of each CAN frame that is sent up to `now`; a start byte is among the data."""
        reached = int((now - self._start) * FRAMES_PER_SECOND)
        first, self._sent = max(self._sent, reached - _MOST), reached
        return [
            (IDS[number % len(IDS)], b"\xaa\x1a\x00" + number.to_bytes(5, "little")) for number in range(first, reached)
        ]
