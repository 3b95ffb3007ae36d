"""What is sent to buttons and faders, from the states of the rig. Pure: times are the caller's.

Positions go out ten times a second and when they change, the rest once a second and when it changes. Nothing is due
before the first reading, and nothing of a reading or a state that is old.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from teleop.links.osc_packets import Argument, packet

EVERY = 0.1  # s between two positions of an axis that rests
SOONEST = 0.02  # s between two of one that moves
AGAIN = 1.0  # s between two of what does not change: a packet may be lost
OLD = 1000.0  # ms from which a reading, or a state, is none
CHANGE = 1e-3  # units by which a position has changed
EARLY = 5e-3  # s that a message may be early, so that ten a second are ten


class Feedback:
    """What is due for one receiver."""

    def __init__(self) -> None:
        self._sent: dict[str, tuple[Argument, float]] = {}
        self.measured = False  # whether there was a reading

    def again(self) -> None:
        """Send everything once more: somebody has asked for it."""
        self._sent.clear()

    def due(self, state: Mapping[str, Any], now: float) -> Iterator[bytes]:
        """Single messages, one for each value."""
        if not state or state["age_ms"] > OLD:
            return
        for name, axis in state["axes"].items():
            if axis["measured"] is not None and axis["measured_age_ms"] <= OLD:
                self.measured = True
                if self._position_due(address := f"/teleop/axis/{name}/position", axis["measured"], now):
                    yield packet(address, float(axis["measured"]))
        if self.measured:
            for address, value in _flags(state).items():
                if self._is_due(address, value, now):
                    yield packet(address, value)

    def _position_due(self, address: str, value: float, now: float) -> bool:
        before, at = self._sent.get(address, (None, -AGAIN))
        changed = not isinstance(before, int | float) or abs(value - before) >= CHANGE
        if now - at < (SOONEST if changed else EVERY) - EARLY:
            return False
        self._sent[address] = value, now
        return True

    def _is_due(self, address: str, value: Argument, now: float) -> bool:
        before, at = self._sent.get(address, (None, 0.0))
        if before == value and now - at < AGAIN:
            return False
        self._sent[address] = value, now
        return True


def _flags(state: Mapping[str, Any]) -> Mapping[str, int | str]:
    """What a button shows."""
    move = state["move"] or {}
    paused = move.get("phase") == "paused"
    return {
        "/teleop/stopped": int(state["stopped"]),
        "/teleop/recording": int(state["recording"]),
        "/teleop/holder": state["holder"] or "",
        "/teleop/playing": int(bool(move) and not paused),
        "/teleop/paused": int(paused),
        "/teleop/move": str(move.get("title", "")),
    }
