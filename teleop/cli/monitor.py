"""`teleop monitor`: what host and gimbal say to each other on a CAN bus, live, from a third party's place.

Each id is a stream of bytes of its own, so each has a reader, and one transcriber remembers who asked what. The JSON
line of a frame is that of `teleop decode`; the line for people is made of it, with the units that the message classes
carry. The rest of the traffic on a gimbal's bus (DJI's own, some 400 frames/s) would bury both, so it is counted. Lines
go to stdout; the status line, where there is a terminal, and the summary go to stderr.
"""

from __future__ import annotations

import json
import math
import sys
import threading
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Annotated, Any

from cyclopts import Parameter
from cyclopts.validators import Number

from teleop.cli.options import DEFAULTS, Options
from teleop.clock import SystemClock
from teleop.dji.frame import Damage, Frame, FrameReader
from teleop.dji.r_sdk import R_SDK
from teleop.dji.record import Record, Transcriber
from teleop.document import DocumentError
from teleop.links import open_listener, parse
from teleop.links.can import GIMBAL_ID, HOST_ID, CanListener
from teleop.profile import Profile

PERIOD = 0.002  # s between looks at the bus, and so the precision of the times
DIRECTIONS: Mapping[int, str] = {HOST_ID: "to gimbal", GIMBAL_ID: "from gimbal"}
_ARROWS: Mapping[str, str] = {"to gimbal": "->", "from gimbal": "<-"}
_MOST_NAMED = 5  # foreign ids in the summary
_REDRAWS = 4  # of the status line, a second

_UNITS: Mapping[tuple[str, bool], Mapping[str, str]] = {
    (cls.name, reply): {field.name: field.wire.unit for field in cls.layout.fields}
    for cls in R_SDK.messages
    for reply in (False, True)
    if cls.reply in (None, reply)
}


def monitor(
    *,
    seconds: Annotated[
        float,
        Parameter(help="End after this time; without it, at Ctrl-C.", validator=Number(gt=0), show_default=False),
    ] = math.inf,
    options: Options = DEFAULTS,
) -> int:
    """Show what host and gimbal say to each other on the rig's CAN bus. Transmits nothing."""
    from teleop.cli.perform import signals_to  # costs what a rig costs, which `send` need not pay for `in_units`

    url = bus_of(options.profile())
    clock, stop = SystemClock(), threading.Event()
    listener = open_listener(url, now=clock.now)
    watch = Watch(listener, options.json)
    try:
        with signals_to(lambda _reason: stop.set()), _status_line(watch):
            print(f"listening on {url}: time in s, -> to the gimbal, <- from it", file=sys.stderr)
            due = begin = clock.now()
            while not stop.is_set() and due - begin <= seconds:
                clock.sleep_until(due)
                watch.look(clock.now() - begin)
                due = max(due + PERIOD, clock.now())
    finally:
        listener.close()
        print(watch.summary(), file=sys.stderr)
    return 130 if stop.is_set() else 0


def bus_of(profile: Profile) -> str:
    """The URL of the CAN bus that the rig's devices are on. Raises DocumentError when there is none."""
    urls = dict.fromkeys(profile.links[sink.link] for sink in profile.sinks)
    for url in urls:
        if parse(url).kind == "can":
            return url
    places = ", ".join(urls) or "no link"
    raise DocumentError(
        [f"there is nothing to monitor on {places} (no CAN bus): --link gimbal=socketcan:can0 names one"]
    )


class Watch:
    """Tells each frame that a listener heard, as a line for people or of JSON, and counts."""

    def __init__(self, listener: CanListener, as_json: bool) -> None:
        self._listener, self._as_json = listener, as_json
        self._readers = {can_id: FrameReader() for can_id in DIRECTIONS}
        self._transcriber = Transcriber(R_SDK)
        self._counts: Counter[str] = Counter()

    def look(self, time: float) -> None:
        """Tell what has been heard up to `time` (s since the start). Raises LinkError when the bus is lost."""
        for can_id, data in self._listener.receive():
            self._tell(time, can_id, self._readers[can_id].feed(data, time))
        for can_id, reader in self._readers.items():
            self._tell(time, can_id, reader.flush(time))

    def summary(self) -> str:
        """What was heard so far, in a line."""
        counts, foreign = self._counts, self._listener.foreign.copy()  # the status line is drawn in a thread
        named = [f"{can_id:#05x} {count}" for can_id, count in foreign.most_common(_MOST_NAMED)]
        if len(foreign) > _MOST_NAMED:
            named.append(f"{len(foreign) - _MOST_NAMED} more ids")
        parts = [
            f"{counts['to gimbal']} frames to the gimbal, {counts['from gimbal']} from it",
            f"{counts['damage']} damaged",
            f"{foreign.total()} of other ids" + (f" ({', '.join(named)})" if named else ""),
            *(f"adapter: {name} {count}" for name, count in self._listener.counts.copy().items()),
        ]
        return ", ".join(parts)

    def _tell(self, time: float, can_id: int, heard: Iterable[Frame | Damage]) -> None:
        direction = DIRECTIONS[can_id]
        for found in heard:
            record = {"time": round(time, 3), "direction": direction, **self._transcriber.record(found)}
            self._counts["damage" if "damage" in record else direction] += 1
            print(json.dumps(record) if self._as_json else line(record), flush=True)


def line(record: Record) -> str:
    """A record with time and direction, for people."""
    start = f"{record['time']:9.3f} {_ARROWS[record['direction']]} "
    if "damage" in record:
        return f"{start}damage: {record['damage']}: {record['bytes']}"
    name = record["message"] + (" reply" if record["reply"] else "")
    return start + ", ".join([name, *(f"{field} {value}" for field, value in in_units(record).items())])


def in_units(record: Record) -> dict[str, str]:
    """The fields of a frame's record (teleop.dji.record) as people read them."""
    units = _UNITS.get((record["message"], record["reply"]), {})
    return {name: f"{_shown(value)} {units.get(name, '')}".rstrip() for name, value in record["fields"].items()}


def _shown(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case float():
            return f"{value:g}"
        case list():
            return ",".join(map(_shown, value)) or "none"
        case {"id": number, "value": data}:  # a user parameter, as `teleop send` takes it
            return f"{number}:{data}"
        case _:
            return str(value)


@contextmanager
def _status_line(watch: Watch) -> Iterator[None]:
    """Keep the summary below the lines while the block runs, where there is a terminal."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    console = Console(stderr=True)
    with Live(
        console=console,
        get_renderable=lambda: Text(watch.summary(), no_wrap=True, overflow="ellipsis"),
        refresh_per_second=_REDRAWS,
        transient=True,
        redirect_stdout=sys.stdout.isatty(),
    ):
        yield
