"""A rig as an operator sees it from afar: its newest state, how old that is, and what it comes to in a word."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from time import monotonic
from typing import TYPE_CHECKING, Any

from teleop.studio.clocks import Offset

if TYPE_CHECKING:
    from teleop.studio.link import Link

LOST = 0.4  # s without a state, after which a rig is lost
SILENT = 2000.0  # ms of the rig's own state, after which its control process hangs
MOVING = ("waiting", "stopping", "releasing", "over")


@dataclass
class RigState:
    """`token` is whether the rig's own token is there, `arrived` when its newest state came (monotonic, s).

    `seen` is when it was last alive, by the wall clock.
    """

    name: str
    state: Mapping[str, Any] = field(default_factory=dict)
    arrived: float = -1e9
    token: bool = False
    gone: float = -1e9  # when its token went last: an older state tells nothing any more
    seen: float = 0.0
    link: Link | None = None
    offset: Offset | None = None

    @property
    def alive(self) -> bool:
        """Whether it was heard just now."""
        fresh = self.arrived > self.gone and monotonic() - self.arrived < LOST
        return self.token and not self.ended and fresh

    @property
    def ended(self) -> bool:
        """Whether it has said itself that its run is over."""
        return self.state.get("run") == "over"

    @property
    def stopped(self) -> bool:
        return bool(self.state.get("stopped"))

    @property
    def word(self) -> str:
        """What it does, in a word."""
        if self.ended:
            return "ended"
        if not self.alive:
            return "lost"
        run, move = self.state.get("run"), self.state.get("move")
        if self.stopped:
            return "stopped"
        if run in MOVING:
            return str(run)
        if isinstance(move, Mapping):
            return str(move.get("phase"))
        if self.state.get("shoot"):
            return "shooting"
        axes = self.state.get("axes")
        moves = isinstance(axes, Mapping) and any(each.get("speed") for each in axes.values())
        return "moving" if moves else "ready"

    @property
    def error(self) -> str:
        """What is wrong with it, "" for nothing."""
        if not self.alive:
            return ""
        if (age := self.state.get("age_ms")) and age > SILENT:
            return f"its control process is silent for {age / 1000:.0f} s"
        for name, link in _maps(self.state.get("links")):
            if link.get("ok") is False:
                return f"{name} does not answer"
        move = self.state.get("move")
        return str(move["why"]) if isinstance(move, Mapping) and move.get("why") else ""

    @property
    def age(self) -> float | None:
        """s since the newest state came; None before there was one."""
        return monotonic() - self.arrived if self.state else None

    def as_json(self) -> dict[str, Any]:
        """For programs: None for what is not known."""
        alive, state, offset, now = self.alive, self.state, self.offset, monotonic()
        axes = {
            name: {key: axis.get(key) for key in ("measured", "commanded", "speed", "unit")}
            for name, axis in _maps(state.get("axes"))
        }
        return {
            "name": self.name,
            "alive": alive,
            "state": self.word,
            "stopped": self.stopped if alive else None,
            "stopped_by": state.get("stopped_by") or None,
            "holder": state.get("holder") if alive else None,
            "move": state.get("move"),
            "error": self.error or None,
            "link_age_ms": None if self.age is None else round(self.age * 1000, 1),
            "battery": battery(state),
            "recording": state.get("recording"),
            "clock_offset_ms": None if offset is None else round(offset.date * 1000, 3),
            "clock_doubt_ms": None if offset is None else round(offset.doubt_at(now) * 1000, 3),
            "seen": round(self.seen, 3) or None,
            "endpoint": None if self.link is None else self.link.endpoint,
            "axes": axes,
        }


def battery(state: Mapping[str, Any]) -> float | None:
    """What is left of it, in percent; None where nothing tells it."""
    found = state.get("battery")
    if isinstance(found, Mapping):
        found = found.get("percent")
    return float(found) if isinstance(found, int | float) and not isinstance(found, bool) else None


def remembered(name: str, seen: float) -> RigState:
    """A rig that was seen by an earlier command."""
    return RigState(name, seen=min(seen, time.time()))


def _maps(value: Any) -> list[tuple[str, Mapping[str, Any]]]:
    return (
        [(key, each) for key, each in value.items() if isinstance(each, Mapping)] if isinstance(value, Mapping) else []
    )
