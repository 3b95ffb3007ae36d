"""Keys from the hand: where the axes are, kept as the next key of a move."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from teleop.core.axes import Motion
from teleop.remote.asked import Asked, Refusal
from teleop.remote.keys import MOST, HandKeys


class KeyActions:
    """`motion` is where the axes are."""

    def __init__(self, keys: HandKeys, motion: Callable[[], Motion]) -> None:
        self._keys, self._motion = keys, motion
        self.do: Mapping[str, Callable[[Asked, float], None]] = {
            "set_key": self._set,
            "delete_key": self._delete,
            "clear_keys": self._clear,
        }

    def _set(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        if len(self._keys.keys) >= MOST:
            raise Refusal(f"there are {MOST} keys already")
        self._keys.set(self._motion())
        asked.end()

    def _delete(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self._keys.delete(asked["number"]):
            raise Refusal(f"there is no key {asked['number']}")
        asked.end()

    def _clear(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._keys.clear()
        asked.end()
