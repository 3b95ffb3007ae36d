"""Says what the guards of the soft limits did, and what the identification noticed, in a line each."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from teleop.core.events import Tick


class GuardNotes:
    """An observer that hands the `lines` of each guard to `notify`, once."""

    def __init__(self, lines: Sequence[list[str]], notify: Callable[[str], object]) -> None:
        self._lines, self._notify = lines, notify

    def observe(self, tick: Tick) -> None:  # noqa: ARG002 - the lines are all it is after
        for lines in self._lines:
            for line in lines:
                self._notify(line)
            lines.clear()
