"""What a controller is sent: lights of what goes on, and motor faders to where their axes are. Pure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from teleop.config.exchange.midi import Control
from teleop.exchange.midi.messages import light, motor
from teleop.exchange.midi.surface import Surface

REFRESH = 2.0  # s until all is sent again: a message is lost now and then, and a controller may have been switched on
OLD = 1000.0  # ms: a state that is older says nothing of the rig

Message = tuple[int, int, int]


class Feedback:
    """`played` is the name of the move that this controller has had played last."""

    def __init__(self, surface: Surface) -> None:
        self._surface = surface
        self._lit: dict[Control, bool] = {}
        self.played = ""
        self._refreshed = -1e9

    def messages(self, state: Mapping[str, Any], now: float) -> Iterator[Message]:
        """What has changed; nothing before the first reading."""
        if all(axis["measured"] is None for axis in state["axes"].values()):
            return
        if now - self._refreshed >= REFRESH:
            self._refreshed = now
            self._lit.clear()
            for fader in self._surface.faders.values():
                fader.sent = None
        yield from self._lights(state)
        for at, fader in self._surface.faders.items():
            measured = state["axes"][self._surface.axis_of(at)]["measured"]
            if measured is None:
                continue
            share = fader.motor_share(measured, now, at.kind != "cc")
            if share is not None:
                yield from motor(at, share)

    def out(self) -> Iterator[Message]:
        """Every light out: the rig is gone."""
        for at, lit in self._lit.items():
            if lit:
                yield light(at, False)
        self._lit = {}

    def _lights(self, state: Mapping[str, Any]) -> Iterator[Message]:
        known = state["age_ms"] < OLD
        for at, command in self._surface.presses.items():
            if (lit := self._is_lit(command, state)) is None:
                continue
            lit = lit and known
            if self._lit.get(at) is not lit:
                self._lit[at] = lit
                yield light(at, lit)

    def _is_lit(self, command: Mapping[str, Any], state: Mapping[str, Any]) -> bool | None:
        """None for a button that has no light."""
        move = state["move"]
        match command["do"]:
            case "stop":
                return bool(state["stopped"])
            case "record":
                return bool(state["recording"])
            case "play":
                return move is not None and command["move"] in (self.played, move["title"])
            case "pause":
                return move is not None and move["phase"] == "paused"
            case "range":
                return state["range"] == command["number"]
            case _:
                return None
