"""`teleop play FILE`: a sequence on a rig."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from teleop.cli.display import Display
from teleop.cli.options import DEFAULTS, Options
from teleop.cli.perform import perform
from teleop.clock import SystemClock, VirtualClock
from teleop.document import DocumentError
from teleop.links import parse
from teleop.profile import Profile
from teleop.rig import open_rig
from teleop.sinks.tally import Tally
from teleop.sources.sequence import SequenceSource

Fast = Annotated[
    bool,
    Parameter(help="Do not wait: simulated time, only on sim: links.", negative=(), show_default=False),
]


def play(
    file: Annotated[str, Parameter(help="A shipped sequence's name, or a file.")],
    /,
    *,
    fast: Fast = False,
    options: Options = DEFAULTS,
) -> int:
    """Play a sequence: ease to its first keyframe, then the move, then say how well the rig followed."""
    profile, performance = options.performance(file)
    clock = the_clock(fast, profile)
    source = SequenceSource(performance, profile.limits)
    tally = Tally(lambda: source.begin)
    display = Display(performance.title, lambda: source.begin, performance.duration, silent=options.json)
    with open_rig(profile, clock) as rig:
        return perform(rig, list(performance.move.tracks), [source], tally, display, options.json)


def the_clock(fast: bool, profile: Profile) -> SystemClock | VirtualClock:
    """The machine's clock, or a virtual one where nothing real is at the end of a link; raises DocumentError."""
    if not fast:
        return SystemClock()
    real = [f"{name}={url}" for name, url in profile.links.items() if parse(url).kind != "sim"]
    if real:
        raise DocumentError([f"--fast: {', '.join(real)} keeps its own time; only sim: links can be played fast"])
    return VirtualClock()
