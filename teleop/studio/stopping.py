"""STOP for several rigs: sent to all at once, again and again, until each rig's own state shows it.

A rig that is heard gets its STOP at once, and does not wait for those that are not.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from time import monotonic, sleep
from typing import NamedTuple

from teleop.studio.fleet import LOOK, Fleet

PATIENCE = 5.0  # s, after which a rig counts as not reached
AGAIN = 0.1  # s between two sendings
ANSWER = 0.5  # s for one answer


class Stopped(NamedTuple):
    """The rigs whose states show the STOP, and those that do not.

    Where all were asked for, `missed` also has the endpoints at which no rig is heard: there may be some.
    """

    stopped: list[str]
    missed: list[str]


def stop(fleet: Fleet, names: Sequence[str] | None = None, patience: float = PATIENCE) -> list[str]:
    """What `stop_rigs` has missed."""
    return stop_rigs(fleet, names, patience).missed


def stop_rigs(fleet: Fleet, names: Sequence[str] | None = None, patience: float = PATIENCE) -> Stopped:
    """STOP for these rigs, or for all that are heard by then and have not ended.

    A rig is stopped when a state shows it that came after the STOP was asked for.
    """
    stopping = _Stopping(fleet, names, monotonic() + patience)
    while not stopping.over and monotonic() < stopping.end:
        sleep(LOOK)
    return stopping.result()


class _Stopping:
    """A STOP until the moment `end`: each rig has a thread from when it is known."""

    def __init__(self, fleet: Fleet, names: Sequence[str] | None, end: float) -> None:
        self._fleet, self._names, self.end = fleet, names, end
        self._asked: dict[str, threading.Thread] = {}
        self._stopped: set[str] = set()

    @property
    def over(self) -> bool:
        """Whether no rig is left to ask; asks those that are known by now."""
        silent = self._fleet.silent  # before the rigs are looked at, or one that comes between is not asked
        for rig in self._fleet.rigs:
            chosen = rig.name in self._names if self._names is not None else not rig.ended
            if chosen and rig.name not in self._asked:
                self._asked[rig.name] = threading.Thread(target=self._ask, args=(rig.name,), daemon=True)
                self._asked[rig.name].start()
        more = silent and (self._names is None or self._asked.keys() < set(self._names))
        return not more and not any(thread.is_alive() for thread in self._asked.values())

    def result(self) -> Stopped:
        """What has come of it, once every thread has ended."""
        for thread in self._asked.values():
            thread.join()
        asked = [*sorted(self._asked), *self._fleet.silent] if self._names is None else list(dict.fromkeys(self._names))
        return Stopped(
            [name for name in asked if name in self._stopped], [name for name in asked if name not in self._stopped]
        )

    def _ask(self, name: str) -> None:
        begun = monotonic()
        rig = self._fleet.rig(name)
        while monotonic() < self.end:
            sent = monotonic()
            self._fleet.ask(name, "command/stop", {"do": "stop"}, ANSWER)
            if self._fleet.until(lambda: rig.stopped and rig.arrived > begun and rig.alive, AGAIN):
                self._stopped.add(name)
                return
            sleep(max(0.0, AGAIN - (monotonic() - sent)))
