"""`teleop check FILE`: whether a rig can play a sequence, without touching a port."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from typing import Annotated, Any

from cyclopts import Parameter

from teleop.cli.options import DEFAULTS, Options
from teleop.document import DocumentError
from teleop.motion import Limits
from teleop.planner.move import Peaks
from teleop.profile import Profile
from teleop.sources.sequence_file import Performance, load_performance


def check(
    file: Annotated[str, Parameter(help="A shipped sequence's name, or a file.")],
    /,
    *,
    options: Options = DEFAULTS,
) -> int:
    """Check a sequence against a rig: every error with its line, or what the move asks of each axis."""
    try:
        profile = options.profile()
        performance = load_performance(file, profile.limits, profile.name)
    except DocumentError as error:
        if options.json:
            print(json.dumps({"ok": False, "problems": error.problems}))
        raise
    for warning in performance.warnings:
        print(warning, file=sys.stderr)
    asked = {axis.value: _share(peaks, profile.limits[axis]) for axis, peaks in performance.move.peaks().items()}
    if options.json:
        found = {"ok": True, "title": performance.title, "duration": performance.duration, "axes": asked}
        print(json.dumps({**found, "warnings": list(performance.warnings)}))
    else:
        _print(performance, profile, asked)
    return 0


def _share(peaks: Peaks, limits: Limits) -> Mapping[str, float | None]:
    """Peak shares of the axis's limits, and the least room to a soft limit in units, None where there is none."""
    room = min(peaks.minimum - limits.minimum, limits.maximum - peaks.maximum)
    return {
        "velocity": peaks.velocity / limits.velocity,
        "acceleration": peaks.acceleration / limits.acceleration,
        "jerk": peaks.jerk / limits.jerk,
        "room": None if limits.continuous else room,
    }


def _print(performance: Performance, profile: Profile, asked: Mapping[str, Mapping[str, Any]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(title=f"{performance.title}: {performance.duration:.2f} s on {profile.name}")
    table.add_column("Axis")
    for heading in ("Velocity", "Acceleration", "Jerk", "Room"):
        table.add_column(heading, justify="right")
    for axis, shares in asked.items():
        used = [f"{shares[name]:.0%}" for name in ("velocity", "acceleration", "jerk")]
        table.add_row(axis, *used, "continuous" if shares["room"] is None else f"{shares['room']:.3g}")
    Console().print(table)
