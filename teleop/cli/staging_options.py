"""The options of `teleop play` that say how a move is begun, how often it is played and what follows it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.options import whole
from teleop.config.quantities import seconds
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.core.interfaces import Clock

if TYPE_CHECKING:
    from teleop.sequence.compile import CompiledSequence
    from teleop.sequence.cycle import Cycle, Trigger

KEY = "key"  # as in key3, the third keyframe


@Parameter(name="*")
@dataclass(frozen=True)
class StagingOptions:
    """Preroll, holds and repeats around the move; without an option, the sequence's own."""

    preroll: Annotated[
        str | None,
        Parameter(metavar="TIME", help="Wait at the start position before the move, as in 3s.", show_default=False),
    ] = None
    back_to_one: Annotated[
        bool | None, Parameter(help="At the end, go back to the first keyframe.", show_default=False)
    ] = None
    start_at: Annotated[
        str | None,
        Parameter(
            metavar="TIME|KEY",
            help="Start at a time or a key (key1 is the first), with a run-up.",
            show_default=False,
        ),
    ] = None
    loop: Annotated[bool, Parameter(help="Repeat until stopped.", negative=(), show_default=False)] = False
    passes: Annotated[
        int | None,
        Parameter(
            metavar="N",
            help="Play N times and report repeatability against the first pass.",
            converter=whole,
            show_default=False,
        ),
    ] = None

    trigger: Annotated[
        str | None,
        Parameter(
            metavar="TRIGGER",
            help="Wait at the start position for a trigger:"
            " key, osc:9000/go, mtc, timecode:01:00:00:00, time:18:30:00.",
        ),
    ] = None

    def staging(self, performance: CompiledSequence, clock: Clock, keys: bool) -> Cycle:
        """The staging asked for; raises UsageError for what this performance has not.

        `clock` is the run's, and `keys` whether there is a terminal.
        """
        from teleop.sequence.cycle import Cycle

        if self.passes is not None and (self.loop or self.passes < 1):
            raise UsageError("--passes: leave out --loop" if self.loop else "--passes: must be at least 1")
        back = performance.back_to_one if self.back_to_one is None else self.back_to_one
        preroll = performance.preroll if self.preroll is None else _time("preroll", self.preroll, performance.fps)
        passes = math.inf if self.loop else self.passes or 1
        trigger = None if self.trigger is None else _trigger(self.trigger, clock, keys)
        return Cycle(preroll, self._start_at(performance), passes, self.passes is not None, back, trigger)

    def _start_at(self, performance: CompiledSequence) -> float:
        text = self.start_at
        if text is None:
            return 0.0
        time = _key(text, performance.key_times) if text.startswith(KEY) else _time("start-at", text, performance.fps)
        if time >= performance.duration:
            raise UsageError(f"--start-at {text}: the move ends at {performance.duration:g} s")
        return time


def _trigger(text: str, clock: Clock, keys: bool) -> Trigger:
    from teleop.sequence.triggers.table import KeyTrigger, read_trigger

    if isinstance(clock, VirtualClock):
        raise UsageError(f"--trigger {text}: needs real time; leave out --fast")
    trigger = read_trigger(text, clock.now)
    if isinstance(trigger, KeyTrigger) and not keys:
        raise UsageError("--trigger key: there is no terminal to press it on")
    return trigger


def _key(text: str, keys: Sequence[float]) -> float:
    number = text.removeprefix(KEY)
    if not number.isdecimal() or not 1 <= int(number) <= len(keys):
        last = f"{KEY}1..{KEY}{len(keys)}" if keys else "no keys: it is a take"
        raise UsageError(f"--start-at {text}: there is {last}")
    return keys[int(number) - 1]


def _time(option: str, text: str, fps: float | None) -> float:
    """`3`, `3s`, `1m30s`, `72f` or timecode in seconds."""
    number = float(text) if text.replace(".", "", 1).isdecimal() else text
    try:
        return seconds(number, fps)
    except ValueError as error:
        raise UsageError(f"--{option} {text}: {error}") from None


NO_STAGING = StagingOptions()
