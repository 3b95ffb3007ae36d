"""`teleop live`: sticks on a rig."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.display import Display
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.perform import perform
from teleop.cli.play import Fast, the_clock
from teleop.motion import Axis
from teleop.rig import open_rig
from teleop.sinks.tally import Tally
from teleop.sources.shaping import shape
from teleop.sources.sticks import SticksSource, read_sticks


def live(
    *,
    sticks: Annotated[Path, Parameter(help="CSV: time in s, and a deflection of -1..1 for each axis.")],
    fast: Fast = False,
    options: Options = DEFAULTS,
) -> int:
    """Move the rig by its sticks, replayed from a file; ends after the last row, when everything is at rest."""
    profile = options.profile()
    recording = read_sticks(sticks, list(profile.axes))
    shaping = profile.sticks

    def velocity(axis: Axis, deflection: float) -> float:
        share = shaping.speed * shape(deflection, shaping.dead_zone, shaping.expo)
        return share * profile.axes[axis].velocity

    clock = the_clock(fast, profile)
    source = SticksSource(recording, velocity)
    tally = Tally(lambda: source.begin)
    display = Display(sticks.name, lambda: source.begin, recording.times[-1], silent=options.json)
    with open_rig(profile, clock) as rig:
        return perform(rig, recording.axes, [source], tally, display, options.json)
