"""`teleop play FILE`: a sequence on a rig."""

from __future__ import annotations

import math
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.display import Display
from teleop.cli.options import DEFAULTS, Options, is_take, warn
from teleop.cli.passes import PassesReport
from teleop.cli.perform import Extra, commands, perform
from teleop.cli.staging_options import NO_STAGING, StagingOptions
from teleop.clock import SystemClock, VirtualClock
from teleop.document import DocumentError
from teleop.links import parse
from teleop.planner.findings import PlanError
from teleop.planner.warp import NoRunUp
from teleop.ports import Sink, UsageError
from teleop.profile import Profile
from teleop.rig import open_rig
from teleop.sinks.recorder import recording
from teleop.sinks.repeatability import Repeatability
from teleop.sinks.tally import Tally
from teleop.sources.conductor import Conductor, PlayKeys
from teleop.sources.keyboard import Keyboard, terminal
from teleop.sources.sequence import SequenceSource

Fast = Annotated[
    bool,
    Parameter(help="Do not wait: simulated time, only on sim: links.", negative=(), show_default=False),
]
Take = Annotated[Path | None, Parameter(name="--take", help="Record everything the run does to a new .mcap file.")]


def play(
    file: Annotated[str, Parameter(help="A shipped sequence's name, a sequence file, or a take (.mcap).")],
    /,
    *,
    speed: Annotated[
        str, Parameter(help="How fast, as a percentage: up to 200, as far as `check` says the move allows.")
    ] = "100%",
    staging: StagingOptions = NO_STAGING,
    rehearse: Annotated[
        bool, Parameter(help="A timelapse's move at its clip's speed, no shutter.", negative=(), show_default=False)
    ] = False,
    fast: Fast = False,
    take: Take = None,
    options: Options = DEFAULTS,
) -> int:
    """Play a sequence: ease to its first keyframe, then the move, then say how well the rig followed."""
    profile, performance, timelapse = options.compiled(file)
    if timelapse is not None:
        if not rehearse:
            raise UsageError(f"{file} is a timelapse: --rehearse plays its move")
        warn(performance)
    title, limits = performance.title, {axis: profile.limits[axis] for axis in performance.move.tracks}
    if is_take(file):
        from teleop.takes.repeat import followable

        profile = followable(profile)
    clock = the_clock(fast, profile)
    rate = percentage("--speed", speed)
    stage = staging.staging(performance)
    try:
        source = SequenceSource(performance, profile.limits, rate, staging=stage)
    except NoRunUp as error:
        raise DocumentError([f"--start-at {staging.start_at}: {error}"]) from None
    except PlanError as error:
        raise DocumentError([f"--speed {speed}: {error}"]) from None
    descriptor = None if fast else terminal()
    keys = None if descriptor is None else Keyboard(descriptor, PlayKeys())
    conductor = None if keys is None else Conductor(source, keys)
    display = Display(
        title,
        lambda: source.begin,
        performance.duration,
        options.json,
        source.playback.time,
        conductor and (lambda: conductor.note),
        source.said,
    )
    with ExitStack() as stack:
        recorder = stack.enter_context(recording(take, profile.name, title, limits, patient=fast))
        rig = stack.enter_context(open_rig(profile, clock))
        said: list[str] = []
        stack.callback(lambda: print(*said, sep="\n", end="\n" if said else "", file=sys.stderr))
        watchers: list[Sink] = [*commands(rig, said.append)]
        if keys is not None and conductor is not None:
            watchers += [stack.enter_context(keys), conductor]
        tally = Tally(lambda: source.begin)
        extras: list[Extra] = []
        if stage.compared:
            repeatability = Repeatability(source.place)
            watchers.append(repeatability)
            extras.append(PassesReport(repeatability))
        axes, sources = list(limits), [conductor or source]
        return perform(rig, axes, sources, tally, display, options.json, recorder, watchers, extras)


def percentage(option: str, text: str) -> float:
    """`150%` or `150` as 1.5; raises DocumentError."""
    try:
        percent = float(text.strip().removesuffix("%"))
    except ValueError:
        percent = math.nan
    if not 0 < percent < math.inf:
        raise DocumentError([f"{option} {text}: must be a percentage above 0, as in 50%"])
    return percent / 100


def the_clock(fast: bool, profile: Profile) -> SystemClock | VirtualClock:
    """The machine's clock, or a virtual one where nothing real is at the end of a link; raises DocumentError."""
    if not fast:
        return SystemClock()
    real = [f"{name}={url}" for name, url in profile.links.items() if parse(url).kind != "sim"]
    if real:
        raise DocumentError([f"--fast: {', '.join(real)} keeps its own time; only sim: links can be played fast"])
    return VirtualClock()
