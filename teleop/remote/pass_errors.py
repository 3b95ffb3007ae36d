"""The errors of the passes of a move, as clients see them: plain values that change only when a pass has ended."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.monitors.pass_errors import PassError, PassErrors
from teleop.sequence.phases import SequencePhase
from teleop.sequence.source import SequenceSource

DIGITS = 5


class ShownPasses:
    """Of the move that plays, or played last. `shown` is None before there was one."""

    def __init__(self) -> None:
        self.shown: Mapping[str, Any] | None = None
        self._source: SequenceSource | None = None
        self._title = ""
        self._axes: Collection[Axis] = ()
        self._errors: PassErrors | None = None
        self._said: Sequence[PassError] = ()

    def watch(self, title: str, source: SequenceSource, axes: Collection[Axis], is_held: Callable[[], object]) -> None:
        """A move begins; while it `is_held` nothing counts."""
        place = lambda time: None if source.playback.paused or is_held() else source.place(time)  # noqa: E731
        self._source, self._title, self._axes = source, title, axes
        self._errors, self._said = PassErrors(place), ()
        self.shown = {"title": title, "passes": []}

    def observe(self, tick: Tick) -> None:
        if self._errors is not None:
            self._errors.observe(tick)
            self._show()
            if self._source is not None and self._source.phase is SequencePhase.OVER:
                self.end()

    def end(self) -> None:
        """The move is over."""
        if self._errors is not None:
            self._errors.end()
            self._show()
            self._errors = None

    def _show(self) -> None:
        if self._errors is not None and self._errors.finished is not self._said:
            self._said = self._errors.finished
            self.shown = {"title": self._title, "passes": [self._plain(each) for each in self._said]}

    def _plain(self, each: PassError) -> Mapping[str, Any]:
        axes = {
            axis.value: {"rms": round(score.rms, DIGITS), "peak": round(score.peak, DIGITS)}
            for axis, score in each.axes.items()
            if axis in self._axes and math.isfinite(score.rms)
        }
        return {"pass": each.number, "axes": axes}
