"""`teleop check FILE`: whether a rig can play a sequence, without touching a port."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping
from typing import Annotated, Any

from cyclopts import Parameter

from teleop.cli.drone_run import is_flown
from teleop.cli.options import DEFAULTS, MOVES, Options, warn
from teleop.cli.screens.folded import tell
from teleop.cli.shipped_files import named
from teleop.cli.timelapse_summary import facts, summary
from teleop.config.profile import Profile
from teleop.core.axes import Limits
from teleop.planner.trajectory import Peaks
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.playback import fastest


def check(
    file: Annotated[str | None, Parameter(help="A shipped move's name, or a file.", completer=MOVES)] = None,
    /,
    *,
    options: Options = DEFAULTS,
) -> int:
    """Check a sequence against a rig: every error with its line, or what the move asks of each axis."""
    profile, performance, timelapse = options.compiled(named("check", file, options.json))
    if timelapse is not None:
        warn(performance)
    most = 1.0 if is_flown(performance.move.tracks) else fastest(performance.move, profile.limits)
    asked = {axis.value: _share(peaks, profile.limits[axis]) for axis, peaks in performance.move.peaks().items()}
    if options.json:
        found = {"ok": True, "title": performance.title, "duration": performance.duration, "axes": asked}
        cues = [{"at": cue.at, "name": cue.name} for cue in performance.cues]
        found |= {"cues": cues, "speed_at_most": most, "warnings": list(performance.warnings)}
        print(json.dumps(found if timelapse is None else {**found, "timelapse": facts(timelapse)}))
    else:
        _print(performance, profile, asked)
        if timelapse is not None:
            tell(f"{summary(timelapse)}. The table is of its rehearsal.")
        if performance.cues:
            counted = Counter(cue.name for cue in performance.cues)
            tell(f"Cues: {', '.join(f'{count} x {name}' if count > 1 else name for name, count in counted.items())}.")
        if is_flown(performance.move.tracks):
            tell("A drone's move is played at its own speed only.")
        else:
            tell(f"Maximum playback speed: {math.floor(100 * most)} %.")
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


def _print(performance: CompiledSequence, profile: Profile, asked: Mapping[str, Mapping[str, Any]]) -> None:
    from teleop.cli.screens.tables import print_table

    rows = []
    for axis, shares in asked.items():
        used = [f"{shares[name]:.0%}" for name in ("velocity", "acceleration", "jerk")]
        rows.append([axis, *used, "continuous" if shares["room"] is None else f"{shares['room']:.3g}"])
    title = f"{performance.title}: {performance.duration:.2f} s on {profile.name}"
    print_table(
        title, ("Axis", "Velocity", "Acceleration", "Jerk", "Room"), rows, words=("Axis",), drop=("Room", "Jerk")
    )
