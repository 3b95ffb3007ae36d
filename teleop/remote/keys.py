"""Keys set by hand: where the axes were, one after the other, and the move that they make."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from teleop.core.axes import Axis, Limits, Motion

MOST = 100
DIGITS = 4
APART = 3.0  # s between two keys, at least
SHARE = 0.4  # of its velocity that an axis needs on average from key to key, at most


class HandKeys:
    """The keys so far; `limits` are those of the rig, for the times between them."""

    def __init__(self, limits: Mapping[Axis, Limits]) -> None:
        self._limits = limits
        self.keys: list[dict[str, float]] = []
        self.changes = 0

    def set(self, motion: Motion) -> int:
        """A key where the axes are; its number, from 1."""
        self.keys.append({axis.value: round(at.position, DIGITS) for axis, at in motion.items() if not axis.is_stick})
        self.changes += 1
        return len(self.keys)

    def delete(self, number: int) -> bool:
        """Whether there was one."""
        if number > len(self.keys):
            return False
        del self.keys[number - 1]
        self.changes += 1
        return True

    def clear(self) -> None:
        self.keys.clear()
        self.changes += 1

    def content(self) -> dict[str, Any]:
        """A sequence file's content: the keys with even times between them, as long as the longest way needs."""
        step = max([APART, *(self._way(*pair) for pair in zip(self.keys, self.keys[1:], strict=False))])
        step = round(step, 1)
        frames = [{"at": round(step * place, 1), **key} for place, key in enumerate(self.keys)]
        return {"title": "keys from the hand", "keyframes": frames}

    def _way(self, one: Mapping[str, float], other: Mapping[str, float]) -> float:
        ways = (
            abs(other[axis.value] - one[axis.value]) / (SHARE * of.velocity)
            for axis, of in self._limits.items()
            if axis.value in one and axis.value in other
        )
        return max(ways, default=0.0)
