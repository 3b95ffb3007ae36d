"""A simulated drone at the far end of a serial line in this process."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from pty_lines import NullModem

from teleop.core.clock import SystemClock
from teleop.links import open_link
from teleop.sim.drone.device import SimulatedDrone

BAUD = 230400
POLL_PERIOD = 0.002  # s between its looks at the line


@contextmanager
def far_drone() -> Iterator[tuple[SimulatedDrone, str]]:
    """The drone, and the URL of the line's other end."""
    clock, stop, cable = SystemClock(), threading.Event(), NullModem()
    far = SimulatedDrone(now=clock.now())
    line = open_link(f"serial:{cable.ports[0]}@{BAUD}", now=clock.now)

    def live() -> None:
        while not stop.wait(POLL_PERIOD):
            far.receive(line.receive(), clock.now())
            if said := far.advance(clock.now()):
                line.send(said)

    thread = threading.Thread(target=live)
    thread.start()
    try:
        yield far, f"serial:{cable.ports[1]}@{BAUD}"
    finally:
        stop.set()
        thread.join()
        line.close()
        cable.close()
