"""What a take knows of the sequence that was played: which it was, where in it each tick is, and its passes again."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from teleop.core.axes import Axis

SAME = 1e-6  # s
NO_PASS = 0


@dataclass(frozen=True)
class SequenceFacts:
    """`fingerprint` is that of the compiled sequence, `keys` has the times (s) of each axis's keys."""

    fingerprint: str = ""
    keys: Mapping[Axis, Sequence[float]] = field(default_factory=dict)

    def record(self) -> dict[str, str]:
        """As strings of a metadata record; none for a run that plays no sequence."""
        if not self.fingerprint:
            return {}
        keys = {axis.value: [round(time, 6) for time in times] for axis, times in self.keys.items()}
        return {"sequence": self.fingerprint, "keys": json.dumps(keys)}


def sequence_facts(metadata: Mapping[str, str]) -> SequenceFacts:
    """From the first metadata record; raises ValueError, KeyError and TypeError for another's."""
    keys = {
        Axis(name): [float(time) for time in times] for name, times in json.loads(metadata.get("keys", "{}")).items()
    }
    return SequenceFacts(metadata.get("sequence", ""), keys)


@dataclass(frozen=True)
class Played:
    """The status of a run that plays a sequence, at a tick.

    `place` is the pass, from 1, and the move's own time in s, None outside a pass. `plan` has the positions (units) of
    the sequence itself where a correction was added to it. `firmware` has versions by the name of the link.
    """

    place: tuple[int, float] | None
    plan: Mapping[Axis, float] = field(default_factory=dict)
    firmware: Mapping[str, str] = field(default_factory=dict)


class Mark(NamedTuple):
    """From `time` (s from the first tick) on the take is in pass `number` at `place` s of the move, and plays on.

    Number 0 is outside a pass.
    """

    time: float
    number: int
    place: float


class PlaceWriter:
    """Which ticks need a mark: those where it does not just play on."""

    def __init__(self) -> None:
        self._last = Mark(0.0, NO_PASS, 0.0)

    def mark(self, time: float, place: tuple[int, float] | None) -> Mark | None:
        number, here = place or (NO_PASS, 0.0)
        last = self._last
        foreseen = last.place + time - last.time
        if number == last.number and (number == NO_PASS or abs(here - foreseen) <= SAME):
            return None
        self._last = Mark(time, number, here)
        return self._last
