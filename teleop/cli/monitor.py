"""`teleop monitor`: what host and device say to each other, live, from a third party's place.

On a CAN bus each id is a stream of bytes of its own, so each has a reader, and one transcriber remembers who asked
what; a serial line carries one direction only, the device's. The JSON line of a frame is that of `teleop decode`;
the line for people is made of it, with the units that the message classes carry. The rest of the traffic on a gimbal's
bus (DJI's own, some 400 frames/s) would bury both, so it is counted. Lines go to stdout; the status line, where there
is a terminal, and the summary go to stderr.
"""

from __future__ import annotations

import json
import math
import sys
import threading
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Annotated

from cyclopts import Parameter
from cyclopts.validators import Number

from teleop.cli.capture_options import NO_CAPTURE, CaptureOptions, capturing
from teleop.cli.codec.drone_options import Model
from teleop.cli.codec.format_message import line
from teleop.cli.monitored_link import Tap, tap
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.signals import signals_to
from teleop.core.clock import SystemClock
from teleop.dji.frame import Damage, Frame, FrameReader
from teleop.dji.json_record import Transcriber
from teleop.links import Listener

POLL_PERIOD = 0.002  # s between looks at the bus, and so the precision of the times
_MOST_NAMED = 5  # foreign ids in the summary
_REDRAWS = 4  # of the status line, a second
_HIDDEN: Mapping[str, str] = {"drone.activate": "app_id"}
"""The secret fields by the command that carries them: screens and logs are read by others."""


def monitor(
    place: Annotated[
        str,
        Parameter(
            metavar="LINK",
            help="Which of the rig's links; without it, its CAN bus, or else its drone's.",
            show_default=False,
        ),
    ] = "",
    /,
    *,
    seconds: Annotated[
        float,
        Parameter(
            metavar="SECONDS",
            help="End after this time; without it, at Ctrl-C.",
            validator=Number(gt=0),
            show_default=False,
        ),
    ] = math.inf,
    capture: CaptureOptions = NO_CAPTURE,
    model: Model = "m100",
    options: Options = DEFAULTS,
) -> int:
    """Show the traffic between host and device on a link of the rig, and record it with -o. Transmits nothing.

    A CAN bus shows both directions. A serial line shows only what the device sends, to one program at a time; an
    acknowledgement there does not name its command.
    """
    tapped = tap(options.profile(), place, model)
    clock, stop = SystemClock(), threading.Event()
    with capturing(capture, tapped, clock.now) as (listener, recording):
        watch = Watch(listener, tapped, options.json)
        try:
            with signals_to(lambda _reason: stop.set()), _status_line(watch):
                print(f"listening on {tapped}", file=sys.stderr)
                due = begin = clock.now()
                while not stop.is_set() and due - begin <= seconds:
                    clock.sleep_until(due)
                    watch.look(clock.now() - begin)
                    if recording:
                        recording.look()
                    due = max(due + POLL_PERIOD, clock.now())
        finally:
            listener.close()
            print(watch.summary(), file=sys.stderr)
    return 130 if stop.is_set() else 0


class Watch:
    """Prints each frame that a listener received, as a line for people or of JSON, and counts."""

    def __init__(self, listener: Listener, tapped: Tap, as_json: bool) -> None:
        self._listener, self._tap, self._as_json = listener, tapped, as_json
        self._readers = {key: FrameReader(in_pieces=tapped.is_bus) for key in tapped.directions}
        self._transcriber = Transcriber(tapped.registry, tapped.cipher)
        self._counts: Counter[str] = Counter()

    def look(self, time: float) -> None:
        """Print what has arrived up to `time` (s since the start). Raises LinkError when the bus is lost."""
        for key, data in self._listener.receive():
            self._tell(time, key, self._readers[key].feed(data, time))
        for key, reader in self._readers.items():
            self._tell(time, key, reader.flush(time))

    def summary(self) -> str:
        """What has arrived so far, in a line."""
        counts, device = self._counts, self._tap.device
        came, damaged = counts[f"from {device}"], f"{counts['damage']} damaged"
        if self._tap.is_bus:
            parts = [f"{counts[f'to {device}']} frames to the {device}", f"{came} from it", damaged, self._strangers()]
        else:
            parts = [f"{came} frames from the {device}", damaged]
        if counts["padded"]:
            parts.append(f"{counts['padded']} padded")
        adapter = (f"adapter: {name} {count}" for name, count in self._listener.counts.copy().items())
        return ", ".join((*parts, *adapter))

    def _strangers(self) -> str:
        foreign = self._listener.foreign.copy()  # the status line is drawn in a thread
        named = [f"{can_id:#05x} {count}" for can_id, count in foreign.most_common(_MOST_NAMED)]
        if len(foreign) > _MOST_NAMED:
            named.append(f"{len(foreign) - _MOST_NAMED} more ids")
        return f"{foreign.total()} of other ids" + (f" ({', '.join(named)})" if named else "")

    def _tell(self, time: float, key: int, heard: Iterable[Frame | Damage]) -> None:
        direction = self._tap.directions[key]
        for found in heard:
            if isinstance(found, Damage) and found.is_padding:
                self._counts["padded"] += 1
                continue
            record = {"time": round(time, 3), "direction": direction, **self._transcriber.record(found)}
            if (secret := _HIDDEN.get(record.get("message", ""))) in record.get("fields", {}):
                record["fields"][secret] = "hidden"
            self._counts["damage" if "damage" in record else direction] += 1
            print(json.dumps(record) if self._as_json else line(record), flush=True)


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
