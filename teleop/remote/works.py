"""What is made ready while the rig goes on: planned by another process, waited for in a thread, begun in a tick."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

from teleop.config.profile import Profile
from teleop.core.errors import TeleopError
from teleop.remote.asked import Asked, Refusal
from teleop.remote.planning_process import PlanningProcess, why

LEAVING = 1.0  # s to wait for the thread at the end


class Work(NamedTuple):
    """What `make` makes in a thread is taken by `begin` in the control thread; what comes too late is given to `drop`.

    `make` may raise TeleopError with the reason.
    """

    make: Callable[[PlanningProcess], Any]
    begin: Callable[[Any], object]
    drop: Callable[[Any], object] = lambda _made: None


class Works:
    """One at a time."""

    def __init__(self, profile: Profile) -> None:
        self._planner = PlanningProcess(profile)
        self._found: deque[tuple[Asked, Work, Any]] = deque()
        self._under_way: Asked | None = None
        self._thread: threading.Thread | None = None
        self._turn = threading.Lock()  # of the planner: what is not wanted any more may still be under way

    def start(self) -> None:
        """Before the run begins: what plans is loaded before the first move is asked for."""
        self._planner.start()

    @property
    def planning(self) -> bool:
        return self._under_way is not None

    def do(self, asked: Asked, work: Work) -> None:
        """Have it made, and begun in a later tick."""
        asked.planning()
        self._under_way = asked
        self._thread = threading.Thread(target=self._work, args=(asked, work), name="plans", daemon=True)
        self._thread.start()

    def deliver(self) -> None:
        """In the control thread, each tick."""
        while self._found:
            asked, work, found = self._found.popleft()
            if asked is not self._under_way:
                if not isinstance(found, str):
                    threading.Thread(target=work.drop, args=(found,), name="plans").start()
                continue
            self._under_way = None
            if isinstance(found, str):
                asked.refuse(Refusal(found))
            else:
                work.begin(found)

    def drop(self, why: str) -> None:
        """Whatever is being planned is not wanted any more."""
        asked, self._under_way = self._under_way, None
        if asked is not None:
            asked.refuse(Refusal(why))

    def close(self) -> None:
        self._planner.close()
        if self._thread is not None:
            self._thread.join(LEAVING)
        self.drop("the run has ended")
        self.deliver()

    def _work(self, asked: Asked, work: Work) -> None:
        with self._turn:
            if asked is not self._under_way:
                return
            try:
                found: Any = work.make(self._planner)
            except TeleopError as error:
                found = why(error)
            except (ArithmeticError, AttributeError, LookupError, OSError, TypeError, ValueError) as error:
                found = f"cannot be planned: {error!r}"
            if asked is self._under_way or isinstance(found, str):
                self._found.append((asked, work, found))
            else:
                work.drop(found)
