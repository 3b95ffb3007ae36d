"""Where the axes are, kept as a preset or as a key by a client's command."""

from __future__ import annotations

from collections.abc import Callable

from teleop.config.presets import Presets
from teleop.core.axes import Motion
from teleop.remote.asked import Asked, Refusal
from teleop.remote.keys import MOST as MOST_KEYS
from teleop.remote.keys import HandKeys


class PlaceActions:
    """`motion` is where the axes are; `notify` takes lines for everybody."""

    def __init__(self, keys: HandKeys, motion: Callable[[], Motion]) -> None:
        self.keys, self._motion = keys, motion
        self.presets: Presets
        self.notify: Callable[[str], object] = lambda _text: None

    def store(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        where = {axis: state.position for axis, state in self._motion().items() if not axis.is_stick}
        self.presets.store(asked["number"], where, asked.get("name"))
        self.notify(f"preset {asked['number']} stored")
        asked.end()

    def delete(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self.presets.delete(asked["number"]):
            raise Refusal(f"there is no preset {asked['number']}")
        self.notify(f"preset {asked['number']} deleted")
        asked.end()

    def set_key(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if len(self.keys.keys) >= MOST_KEYS:
            raise Refusal(f"there are {MOST_KEYS} keys already")
        self.keys.set(self._motion())
        asked.end()

    def delete_key(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self.keys.delete(asked["number"]):
            raise Refusal(f"there is no key {asked['number']}")
        asked.end()

    def clear_keys(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self.keys.clear()
        asked.end()
