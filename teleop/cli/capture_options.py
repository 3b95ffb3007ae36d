"""The options of `teleop monitor` that record a capture, and the capture that they make."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Group, Parameter

from teleop.captures.candump import interface_name
from teleop.captures.captured import Source
from teleop.captures.recording import Recording
from teleop.captures.serial_numbers import SerialNumbers
from teleop.captures.writer import CaptureWriter, check_file
from teleop.cli.monitored_link import Tap
from teleop.cli.take.options import Overwrite
from teleop.core.errors import UsageError
from teleop.links import Listener, open_listener, parse

CAPTURE = Group("Capture", sort_key=1)


@Parameter(name="*")
@dataclass(frozen=True)
class CaptureOptions:
    """Where the traffic is recorded."""

    output: Annotated[
        Path | None,
        Parameter(
            name=("--output", "-o"),
            metavar="FILE",
            group=CAPTURE,
            help="Record all traffic: as candump's log (.log, .candump) or as MCAP (.mcap), a serial line as MCAP.",
            show_default=False,
        ),
    ] = None
    overwrite: Annotated[Overwrite, Parameter(group=CAPTURE)] = False
    serial: Annotated[
        bool, Parameter(group=CAPTURE, help="Keep serial numbers in it.", negative=(), show_default=False)
    ] = False


NO_CAPTURE = CaptureOptions()


@contextmanager
def capturing(
    options: CaptureOptions, tapped: Tap, now: Callable[[], float]
) -> Iterator[tuple[Listener, Recording | None]]:
    """The listener, and what records all that it hears. The link is opened first: a failure leaves no file.

    Raises UsageError, OutputError and LinkError.
    """
    file = options.output
    if file is None:
        if options.overwrite or options.serial:
            raise UsageError("--overwrite and --serial are about a capture: add -o FILE")
        yield open_listener(tapped.url, now=now), None
        return
    address = parse(tapped.url)
    kind, device = ("can" if tapped.is_bus else "serial"), ("drone" if tapped.device == "drone" else "gimbal")
    source = Source(kind, interface_name(address.channel), device)
    check_file("-o", file, source, options.overwrite)
    heard: list[Recording] = []
    listener = open_listener(address, now=now, tap=lambda frame: heard[0].hear(frame))
    recording = Recording(CaptureWriter(file, source), None if options.serial else SerialNumbers(source), now)
    heard.append(recording)
    try:
        yield listener, recording
    finally:
        recording.close()
        print(recording.summary(), file=sys.stderr)
