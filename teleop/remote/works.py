"""Moves that are planned while the rig goes on: by another process, waited for in a thread, taken over in a tick."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.errors import TeleopError
from teleop.remote.asked import Asked, Refusal
from teleop.remote.follower import Follower
from teleop.remote.moves import move_file
from teleop.remote.planning_process import PlanningProcess, why
from teleop.remote.play_job import PlayJob
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource

Begin = Callable[[Asked, PlayJob], object]
LEAVING = 1.0  # s to wait for the thread at the end

# What is planned must have been loaded before the run: a module that loads meanwhile holds the control thread up.
_LOADED = (CompiledSequence, SequenceSource)


class Works:
    """`folder` has the moves that clients may name."""

    def __init__(self, profile: Profile, limits: Mapping[Axis, Limits], folder: Path) -> None:
        self._limits, self._folder = limits, folder
        self._planner = PlanningProcess(profile)
        self._found: deque[tuple[Asked, Begin, PlayJob | str]] = deque()
        self._under_way: Asked | None = None
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Before the run begins: what plans is loaded before the first move is asked for."""
        self._planner.start()

    @property
    def planning(self) -> bool:
        return self._under_way is not None

    def plan(self, asked: Asked, what: str | Mapping[str, Any], begin: Begin) -> None:
        """Plan a move of that name, or with that content, and `begin` it in a later tick."""
        self._under_way = asked
        self._thread = threading.Thread(target=self._work, args=(asked, what, begin), name="plans", daemon=True)
        self._thread.start()

    def deliver(self, now: float) -> None:  # noqa: ARG002 - in the control thread, each tick
        while self._found:
            asked, begin, found = self._found.popleft()
            if asked is not self._under_way:
                continue
            self._under_way = None
            if isinstance(found, str):
                asked.refuse(Refusal(found))
            else:
                begin(asked, found)

    def drop(self, why: str) -> None:
        """Whatever is being planned is not wanted any more."""
        asked, self._under_way = self._under_way, None
        if asked is not None:
            asked.refuse(Refusal(why))

    def close(self) -> None:
        self._planner.close()
        if self._thread is not None:
            self._thread.join(LEAVING)

    def _work(self, asked: Asked, what: str | Mapping[str, Any], begin: Begin) -> None:
        try:
            found: PlayJob | str = self._made(asked, what)
        except TeleopError as error:
            found = why(error)
        except (ArithmeticError, AttributeError, LookupError, OSError, TypeError, ValueError) as error:
            found = f"cannot be planned: {error!r}"
        self._found.append((asked, begin, found))

    def _made(self, asked: Asked, what: str | Mapping[str, Any]) -> PlayJob:
        compiled = self._planner.plan(move_file(what, self._folder) if isinstance(what, str) else what)
        passes = float("inf") if asked.get("loop", False) else asked.get("passes", 1)
        preroll = asked.get("preroll", compiled.preroll)
        follower = Follower() if asked.get("chase", False) else None
        cycle = Cycle(preroll, passes=passes, back_to_one=compiled.back_to_one, trigger=follower)
        missing = [axis for axis in compiled.move.tracks if axis not in self._limits]
        if missing:
            raise TeleopError(f"{compiled.title}: this run has no {', '.join(missing)}")
        source = SequenceSource(compiled, self._limits, asked.get("speed", 1.0), cycle=cycle)
        return PlayJob(compiled.title, asked.command.session, source, asked.get("attended", True), asked.end, follower)
