"""STOP for several rigs: sent to all at once, again and again, until each rig's own state shows it."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from time import monotonic, sleep

from teleop.studio.fleet import Fleet, side_by_side

PATIENCE = 5.0  # s, after which a rig counts as not reached
AGAIN = 0.1  # s between two sendings
ANSWER = 0.5  # s for one answer


def stop(fleet: Fleet, names: Sequence[str] | None = None, patience: float = PATIENCE) -> list[str]:
    """STOP for these rigs, or for all that are known and have not ended; the names of those that do not show it.

    A rig is stopped when a state shows it that came after the STOP was asked for.
    """
    chosen = [rig.name for rig in fleet.rigs if not rig.ended] if names is None else list(dict.fromkeys(names))
    left: set[str] = set(chosen)
    lock = threading.Lock()
    end = monotonic() + patience

    def until_stopped(name: str) -> None:
        begun = monotonic()
        rig = fleet.rig(name)
        while monotonic() < end:
            sent = monotonic()
            fleet.ask(name, "command/stop", {"do": "stop"}, ANSWER)
            fleet.until(lambda: rig.stopped and rig.arrived > begun and rig.alive, AGAIN)
            if rig.stopped and rig.arrived > begun and rig.alive:
                with lock:
                    left.discard(name)
                return
            sleep(max(0.0, AGAIN - (monotonic() - sent)))

    side_by_side(chosen, until_stopped)
    return [name for name in chosen if name in left]
