"""What `teleop send` does for every device: the way there, and the report of the outcome."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from teleop.core.errors import DeviceError
from teleop.core.interfaces import Clock, Link
from teleop.dji.json_record import Record
from teleop.links import open_link, parse
from teleop.sim.link import Device, SimLink


@contextmanager
def opened(url: str, clock: Clock, simulated: Callable[[], Device]) -> Iterator[Link]:
    """The link at `url`, closed in the end; for `sim:`, one to a device that is made now. Raises LinkError."""
    if parse(url).kind == "sim":
        yield SimLink(simulated(), clock.now)
        return
    link = open_link(url, now=clock.now)
    try:
        yield link
    finally:
        link.close()


def tell(name: str, record: Record, reason: str, lines: Iterable[str], as_json: bool) -> None:
    """Print what came of the command `name`: its record, or `lines` for people.

    Raises DeviceError when there is a `reason` for which it was not done.
    """
    if as_json:
        print(json.dumps(record))
    elif not reason:
        print(*lines, sep="\n")
    if reason:
        raise DeviceError(f"{name} was refused: {reason}")
